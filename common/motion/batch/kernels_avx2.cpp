// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_VECTOR_WIDTH 4
#define SIDESTEP_LEVEL_NAME "avx2"
#define SIDESTEP_KERNELS kAvx2Kernels
#include "common/motion/batch/kernels_code.hpp"
