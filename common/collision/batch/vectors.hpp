// SPDX-License-Identifier: Apache-2.0
// Included by sources that are compiled for one instruction set, after they say how many floats its vectors
// hold. They must not include anything that has inline functions: the linker would keep one copy, perhaps
// that of an instruction set which the machine does not have. Intrinsics are always inlined.
#include "common/collision/batch/kernels.hpp"
#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace sidestep::collision {
namespace {

constexpr std::size_t kWidth = SIDESTEP_VECTOR_WIDTH;
typedef float Vector __attribute__((vector_size(kWidth * sizeof(float))));

inline Vector load(const float* lanes) {
  Vector v;
  __builtin_memcpy(&v, lanes, sizeof v);
  return v;
}
inline Vector all(float value) { return value - Vector{}; }

#if SIDESTEP_VECTOR_WIDTH == 16
// g++ 12 warns of the forms without a mask.
inline Vector smaller(const Vector& a, const Vector& b) { return _mm512_maskz_min_ps(0xffff, a, b); }
inline Vector larger(const Vector& a, const Vector& b) { return _mm512_maskz_max_ps(0xffff, a, b); }
/// Bit k: whether a.lane k <= b.lane k.
inline unsigned not_above(const Vector& a, const Vector& b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
#elif SIDESTEP_VECTOR_WIDTH == 8
inline Vector smaller(const Vector& a, const Vector& b) { return _mm256_min_ps(a, b); }
inline Vector larger(const Vector& a, const Vector& b) { return _mm256_max_ps(a, b); }
inline unsigned not_above(const Vector& a, const Vector& b) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
}
#else
inline Vector smaller(const Vector& a, const Vector& b) { return a < b ? a : b; }
inline Vector larger(const Vector& a, const Vector& b) { return a > b ? a : b; }
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
#endif

}  // namespace
}  // namespace sidestep::collision
