// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 4
#define SIDESTEP_KERNELS kAvx2Forecasting
#include "agents/batch/forecasting_code.hpp"
