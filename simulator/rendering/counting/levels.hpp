// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/rendering/counting/kernels.hpp"

namespace sidestep::counting {

extern const Kernels kBaselineKernels;
#ifdef __x86_64__
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

}  // namespace sidestep::counting
