// SPDX-License-Identifier: Apache-2.0
#include "common/motion/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 8
#define SIDESTEP_KERNELS kAvx512Choosing
#include "common/motion/batch/choosing_code.hpp"
