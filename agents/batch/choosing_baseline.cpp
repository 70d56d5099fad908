// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 2
#define SIDESTEP_KERNELS kBaselineChoosing
#include "agents/batch/choosing_code.hpp"
