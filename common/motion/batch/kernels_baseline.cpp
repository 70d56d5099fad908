// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_VECTOR_WIDTH 2
#define SIDESTEP_LEVEL_NAME "baseline"
#define SIDESTEP_KERNELS kBaselineKernels
#include "common/motion/batch/kernels_code.hpp"
