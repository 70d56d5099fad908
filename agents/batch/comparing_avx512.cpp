// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 8
#define SIDESTEP_KERNELS kAvx512Comparing
#include "agents/batch/comparing_code.hpp"
