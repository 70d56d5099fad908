// SPDX-License-Identifier: Apache-2.0
#include "common/motion/batch/dispatch.hpp"

#include "common/motion/batch/levels.hpp"

namespace sidestep::batch {

std::vector<const Kernels*> available_kernels() {
  std::vector<const Kernels*> found{&kBaselineKernels};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) found.push_back(&kAvx2Kernels);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    found.push_back(&kAvx512Kernels);
#endif
  return found;
}

const Kernels& best_kernels() {
  static const Kernels& best = *available_kernels().back();
  return best;
}

}  // namespace sidestep::batch
