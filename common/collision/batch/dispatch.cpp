// SPDX-License-Identifier: Apache-2.0
#include "common/collision/batch/dispatch.hpp"

#include "common/collision/batch/levels.hpp"
#include "common/processor/instruction_set.hpp"

namespace sidestep::collision {
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

}  // namespace sidestep::collision
