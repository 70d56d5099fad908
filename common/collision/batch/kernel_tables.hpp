// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/batch/kernels.hpp"

namespace sidestep::collision {

extern const Kernels kBaselineKernels;
#ifdef __x86_64__
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

}  // namespace sidestep::collision
