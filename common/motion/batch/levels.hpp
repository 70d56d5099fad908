// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/batch/kernels.hpp"

namespace sidestep::batch {

extern const Kernels kBaselineKernels;
#ifdef __x86_64__
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

}  // namespace sidestep::batch
