// SPDX-License-Identifier: Apache-2.0
#include "common/collision/batch/dispatch.hpp"

#include "common/collision/batch/kernel_tables.hpp"
#include "common/processor/instruction_set.hpp"

namespace sidestep::collision {

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> kernels = runnable<Kernels>({
      {InstructionSet::kBaseline, kBaselineKernels},
#ifdef __x86_64__
      {InstructionSet::kAvx2, kAvx2Kernels},
      {InstructionSet::kAvx512, kAvx512Kernels},
#endif
  });
  return kernels;
}

const Kernels& best_kernels() { return available_kernels().back(); }

}  // namespace sidestep::collision
