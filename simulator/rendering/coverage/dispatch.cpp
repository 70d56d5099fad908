// SPDX-License-Identifier: Apache-2.0
#include "common/processor/instruction_set.hpp"
#include "simulator/rendering/coverage/kernel_tables.hpp"

namespace sidestep::coverage {
namespace {

std::vector<Kernels> supported_kernels() {
  std::vector<Kernels> kernels{kBaselineKernels};
#ifdef __x86_64__
  if (best_instruction_set() >= InstructionSet::kAvx2) kernels.push_back(kAvx2Kernels);
  if (best_instruction_set() >= InstructionSet::kAvx512) kernels.push_back(kAvx512Kernels);
#endif
  return kernels;
}

}  // namespace

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> kernels = supported_kernels();
  return kernels;
}

const Kernels& best_kernels() { return available_kernels().back(); }

}  // namespace sidestep::coverage
