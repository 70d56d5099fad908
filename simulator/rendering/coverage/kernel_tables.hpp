// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/rendering/coverage/kernels.hpp"

namespace sidestep::coverage {

// The kernels of each instruction set. dispatch.cpp selects the ones that the machine can run.
extern const Kernels kBaselineKernels;
#ifdef __x86_64__
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

}  // namespace sidestep::coverage
