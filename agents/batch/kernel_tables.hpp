// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/batch/kernels.hpp"

namespace sidestep::batch {

// Kernels of each instruction set. dispatch.cpp lists the kernels that the machine can run.
extern const ComparisonKernels kBaselineComparison;
extern const ChoiceKernels kBaselineChoice;
extern const PredictionKernels kBaselinePrediction;
#ifdef __x86_64__
extern const ComparisonKernels kAvx2Comparison, kAvx512Comparison;
extern const ChoiceKernels kAvx2Choice, kAvx512Choice;
extern const PredictionKernels kAvx2Prediction, kAvx512Prediction;
#endif

}  // namespace sidestep::batch
