// SPDX-License-Identifier: Apache-2.0
#include "common/collision/batch/dispatch.hpp"

#include "common/collision/batch/levels.hpp"

namespace sidestep::collision {
namespace {

std::vector<Kernels> found() {
  std::vector<Kernels> kernels{kBaselineKernels};
#ifdef __x86_64__
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                        __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                        __builtin_cpu_supports("popcnt");
  if (has_avx2) kernels.push_back(kAvx2Kernels);
  if (has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    kernels.push_back(kAvx512Kernels);
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
