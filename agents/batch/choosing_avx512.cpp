// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 8
#define SIDESTEP_KERNELS kAvx512Choosing
#include "agents/batch/choosing_code.hpp"
