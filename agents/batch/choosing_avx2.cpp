// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 4
#define SIDESTEP_KERNELS kAvx2Choosing
#include "agents/batch/choosing_code.hpp"
