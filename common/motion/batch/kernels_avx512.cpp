// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_VECTOR_WIDTH 8
#define SIDESTEP_LEVEL_NAME "avx512"
#define SIDESTEP_KERNELS kAvx512Kernels
#include "common/motion/batch/kernels_code.hpp"
