// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// What inner loops are compiled for; each includes the ones before.
enum class InstructionSet {
  kBaseline,  ///< what every processor of the architecture has
  kAvx2,      ///< and FMA, BMI 1 and 2, POPCNT
  kAvx512,    ///< F, DQ and VL
};

/// The best that this processor and its operating system offer. Code that is compiled for an instruction set
/// may use all that is listed for it here, and no more.
inline InstructionSet best_instruction_set() {
#ifdef __x86_64__
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                        __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                        __builtin_cpu_supports("popcnt");
  const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512vl");
  if (has_avx2) return has_avx512 ? InstructionSet::kAvx512 : InstructionSet::kAvx2;
#endif
  return InstructionSet::kBaseline;
}

}  // namespace sidestep
