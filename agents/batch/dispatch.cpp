// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/dispatch.hpp"

#include "agents/batch/levels.hpp"
#include "common/processor/instruction_set.hpp"

namespace sidestep::batch {

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> kernels = runnable<Kernels>({
      {InstructionSet::kBaseline, {"baseline", kBaselineComparing, kBaselineChoosing, kBaselineForecasting}},
#ifdef __x86_64__
      {InstructionSet::kAvx2, {"avx2", kAvx2Comparing, kAvx2Choosing, kAvx2Forecasting}},
      {InstructionSet::kAvx512, {"avx512", kAvx512Comparing, kAvx512Choosing, kAvx512Forecasting}},
#endif
  });
  return kernels;
}

const Kernels& best_kernels() { return available_kernels().back(); }

}  // namespace sidestep::batch
