// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/levels.hpp"

#define SIDESTEP_VECTOR_WIDTH 2
#define SIDESTEP_KERNELS kBaselineForecasting
#include "agents/batch/forecasting_code.hpp"
