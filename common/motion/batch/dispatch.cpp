// SPDX-License-Identifier: Apache-2.0
#include "common/motion/batch/dispatch.hpp"

#include "common/motion/batch/levels.hpp"
#include "common/processor/instruction_set.hpp"

namespace sidestep::batch {
namespace {

std::vector<Kernels> found() {
  std::vector<Kernels> kernels{{"baseline", kBaselineComparing, kBaselineChoosing, kBaselineForecasting}};
#ifdef __x86_64__
  if (best_instruction_set() >= InstructionSet::kAvx2)
    kernels.push_back({"avx2", kAvx2Comparing, kAvx2Choosing, kAvx2Forecasting});
  if (best_instruction_set() >= InstructionSet::kAvx512)
    kernels.push_back({"avx512", kAvx512Comparing, kAvx512Choosing, kAvx512Forecasting});
#endif
  return kernels;
}

}  // namespace

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> kernels = found();
  return kernels;
}

const Kernels& best_kernels() { return available_kernels().back(); }

}  // namespace sidestep::batch
