// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/dispatch.hpp"

#include "agents/batch/kernel_tables.hpp"
#include "common/processor/instruction_set.hpp"

namespace sidestep::batch {

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> kernels = runnable<Kernels>({
      {InstructionSet::kBaseline, {"baseline", kBaselineComparison, kBaselineChoice, kBaselinePrediction}},
#ifdef __x86_64__
      {InstructionSet::kAvx2, {"avx2", kAvx2Comparison, kAvx2Choice, kAvx2Prediction}},
      {InstructionSet::kAvx512, {"avx512", kAvx512Comparison, kAvx512Choice, kAvx512Prediction}},
#endif
  });
  return kernels;
}

const Kernels& best_kernels() { return available_kernels().back(); }

}  // namespace sidestep::batch
