// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <vector>

namespace sidestep {

/// The instruction sets that kernels are compiled for; each includes the preceding ones.
enum class InstructionSet {
  kBaseline,    ///< common to all processors of the architecture
  kAvx2,        ///< AVX2, FMA, BMI 1 and 2, POPCNT
  kAvx512,      ///< AVX-512 F, DQ and VL
  kAvx512Bytes  ///< AVX-512 BW and VBMI
};

/// The best instruction set that this processor and its operating system support. Code compiled for an
/// instruction set may use exactly the extensions listed for it above.
inline InstructionSet best_instruction_set() {
#ifdef __x86_64__
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                        __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                        __builtin_cpu_supports("popcnt");
  const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512vl");
  const bool has_bytes = __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vbmi");
  if (has_avx2 && has_avx512) return has_bytes ? InstructionSet::kAvx512Bytes : InstructionSet::kAvx512;
  if (has_avx2) return InstructionSet::kAvx2;
#endif
  return InstructionSet::kBaseline;
}

/// Kernels that were compiled for an instruction set.
template <typename Kernels>
struct CompiledFor {
  InstructionSet required;
  Kernels kernels;
};

/// The kernels that this machine can run, in the given order.
template <typename Kernels>
std::vector<Kernels> runnable(std::initializer_list<CompiledFor<Kernels>> all) {
  std::vector<Kernels> found;
  for (const CompiledFor<Kernels>& one : all) {
    if (one.required <= best_instruction_set()) found.push_back(one.kernels);
  }
  return found;
}

}  // namespace sidestep
