// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/batch/dispatch.hpp"

#include "common/processor/instruction_set.hpp"
#include "vision/segmentation/batch/kernel_tables.hpp"

namespace sidestep::segmentation {

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> kernels = runnable<Kernels>({
      {InstructionSet::kBaseline, kBaselineKernels},
#ifdef __x86_64__
      {InstructionSet::kAvx2, kAvx2Kernels},
      {InstructionSet::kAvx512Bytes, kAvx512Kernels},
#endif
  });
  return kernels;
}

const Kernels& best_kernels() { return available_kernels().back(); }

}  // namespace sidestep::segmentation
