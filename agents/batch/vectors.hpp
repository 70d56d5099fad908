// SPDX-License-Identifier: Apache-2.0
// Vector types for sources that are compiled for one instruction set. Before including it, a source defines
// the number of doubles in a vector, and whether it computes in single precision. Such a source must not
// include headers with inline functions: the linker keeps a single copy of each, possibly one with
// instructions that the machine lacks.
#include "agents/batch/kernels.hpp"

namespace sidestep::batch {
namespace {

#ifdef SIDESTEP_SINGLE_PRECISION
typedef float Number;
typedef PredictionRow NumberRow;
#else
typedef double Number;
typedef Row NumberRow;
#endif
constexpr std::size_t kWidth = SIDESTEP_VECTOR_WIDTH * sizeof(double) / sizeof(Number);
typedef Number Vector __attribute__((vector_size(kWidth * sizeof(Number))));

constexpr double kInfinity = __builtin_inf();

inline Vector load(const NumberRow& row, std::size_t at) {
  Vector v;
  __builtin_memcpy(&v, &row.lane[at], sizeof v);
  return v;
}
inline void store(NumberRow& row, std::size_t at, const Vector& v) {
  __builtin_memcpy(&row.lane[at], &v, sizeof v);
}
inline Vector broadcast(Number value) { return value - Vector{}; }
inline Vector min(const Vector& a, const Vector& b) { return a < b ? a : b; }
inline Vector max(const Vector& a, const Vector& b) { return a > b ? a : b; }
inline Vector square_root(const Vector& v) {
  Vector result;
#ifdef SIDESTEP_SINGLE_PRECISION
  for (std::size_t i = 0; i < kWidth; ++i) result[i] = __builtin_sqrtf(v[i]);
#else
  for (std::size_t i = 0; i < kWidth; ++i) result[i] = __builtin_sqrt(v[i]);
#endif
  return result;
}
/// Bit k is set if a[k] <= b[k].
inline unsigned less_equal_bits(const Vector& a, const Vector& b) {
  const auto is = a <= b;
  unsigned bits = 0;
  for (std::size_t i = 0; i < kWidth; ++i) {
    // Separate from the shift: in a single expression, g++ 12 with -fsanitize=shift selects a wrong lane.
    const auto lane = static_cast<unsigned>(is[i] & 1);
    bits |= lane << i;
  }
  return bits;
}

}  // namespace
}  // namespace sidestep::batch
