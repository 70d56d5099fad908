// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/batch/kernels.hpp"

namespace sidestep::batch {

extern const ComparingKernels kBaselineComparing;
extern const ChoosingKernels kBaselineChoosing;
#ifdef __x86_64__
extern const ComparingKernels kAvx2Comparing, kAvx512Comparing;
extern const ChoosingKernels kAvx2Choosing, kAvx512Choosing;
#endif

}  // namespace sidestep::batch
