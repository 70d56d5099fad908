// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_WIDTH 4
#define SIDESTEP_KERNELS kAvx2Prediction
#include "agents/batch/predict_impl.hpp"
