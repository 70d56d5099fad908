// SPDX-License-Identifier: Apache-2.0
// Included by sources that are compiled for one instruction set, after they say how many doubles its vectors
// hold, and whether they compute in single precision. They must not include anything that has inline
// functions: the linker would keep one copy, perhaps that of an instruction set which the machine does not
// have.
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
inline Vector all(Number value) { return value - Vector{}; }
inline Vector smaller(const Vector& a, const Vector& b) { return a < b ? a : b; }
inline Vector larger(const Vector& a, const Vector& b) { return a > b ? a : b; }
inline Vector root(const Vector& v) {
  Vector result;
#ifdef SIDESTEP_SINGLE_PRECISION
  for (std::size_t i = 0; i < kWidth; ++i) result[i] = __builtin_sqrtf(v[i]);
#else
  for (std::size_t i = 0; i < kWidth; ++i) result[i] = __builtin_sqrt(v[i]);
#endif
  return result;
}
/// Bit k: whether lane `at` + k is a.lane <= b.lane.
inline unsigned not_above(const Vector& a, const Vector& b) {
  const auto is = a <= b;
  unsigned bits = 0;
  for (std::size_t i = 0; i < kWidth; ++i) {
    // In one expression with the shift, g++ 12 takes a wrong lane under -fsanitize=shift.
    const auto lane = static_cast<unsigned>(is[i] & 1);
    bits |= lane << i;
  }
  return bits;
}

}  // namespace
}  // namespace sidestep::batch
