// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vision/segmentation/batch/kernels.hpp"

namespace sidestep::segmentation {

// Kernels of each instruction set. dispatch.cpp lists those that the machine can run.
extern const Kernels kBaselineKernels;
#ifdef __x86_64__
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

}  // namespace sidestep::segmentation
