// SPDX-License-Identifier: Apache-2.0
#include "common/processor/instruction_set.hpp"
#include "simulator/rendering/counting/levels.hpp"

namespace sidestep::counting {
namespace {

std::vector<Kernels> found() {
  std::vector<Kernels> kernels{kBaselineKernels};
#ifdef __x86_64__
  if (best_instruction_set() >= InstructionSet::kAvx2) kernels.push_back(kAvx2Kernels);
  if (best_instruction_set() >= InstructionSet::kAvx512) kernels.push_back(kAvx512Kernels);
#endif
  return kernels;
}

}  // namespace

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> kernels = found();
  return kernels;
}

const Kernels& best_kernels() { return available_kernels().back(); }

}  // namespace sidestep::counting
