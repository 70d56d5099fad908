// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 4
#define SIDESTEP_KERNELS kAvx2Comparing
#include "agents/batch/comparing_code.hpp"
