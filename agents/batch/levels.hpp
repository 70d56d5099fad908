// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/batch/kernels.hpp"

namespace sidestep::batch {

extern const ComparingKernels kBaselineComparing;
extern const ChoosingKernels kBaselineChoosing;
extern const PredictionKernels kBaselineForecasting;
#ifdef __x86_64__
extern const ComparingKernels kAvx2Comparing, kAvx512Comparing;
extern const ChoosingKernels kAvx2Choosing, kAvx512Choosing;
extern const PredictionKernels kAvx2Forecasting, kAvx512Forecasting;
#endif

}  // namespace sidestep::batch
