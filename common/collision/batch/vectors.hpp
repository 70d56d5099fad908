// SPDX-License-Identifier: Apache-2.0
// Included by sources compiled for one instruction set, after they define SIDESTEP_VECTOR_WIDTH, the number
// of floats in a vector. These sources must not include headers with inline functions: the linker would keep
// one copy, possibly for an instruction set that the machine lacks. Intrinsics are always inlined.
#include "common/collision/batch/kernels.hpp"
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace sidestep::collision {
namespace {

constexpr std::size_t kWidth = SIDESTEP_VECTOR_WIDTH;
typedef float Vector __attribute__((vector_size(kWidth * sizeof(float))));
typedef float FourFloats __attribute__((vector_size(16)));
typedef double TwoDoubles __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

template <typename V>
inline V load(const float* lanes) {
  V v;
  __builtin_memcpy(&v, lanes, sizeof v);
  return v;
}
template <typename V>
inline V all(float value) {
  return value - V{};
}

// Uses intrinsics because g++ does not compile `a < b ? a : b` to one instruction for all of these types.
// not_above: bit k is set if lane k of a is <= lane k of b.
#ifdef __AVX2__
inline FourFloats smaller(const FourFloats& a, const FourFloats& b) { return _mm_min_ps(a, b); }
inline FourFloats larger(const FourFloats& a, const FourFloats& b) { return _mm_max_ps(a, b); }
inline unsigned not_above(const FourFloats& a, const FourFloats& b) {
  return static_cast<unsigned>(_mm_movemask_ps(_mm_cmp_ps(a, b, _CMP_LE_OQ)));
}
#if SIDESTEP_VECTOR_WIDTH == 8
inline Vector smaller(const Vector& a, const Vector& b) { return _mm256_min_ps(a, b); }
inline Vector larger(const Vector& a, const Vector& b) { return _mm256_max_ps(a, b); }
inline unsigned not_above(const Vector& a, const Vector& b) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
}
#else
// Uses masked intrinsics because g++ 12 warns about the unmasked ones.
inline Vector smaller(const Vector& a, const Vector& b) { return _mm512_maskz_min_ps(0xffff, a, b); }
inline Vector larger(const Vector& a, const Vector& b) { return _mm512_maskz_max_ps(0xffff, a, b); }
inline unsigned not_above(const Vector& a, const Vector& b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
#endif
#else
template <typename V>
inline V smaller(const V& a, const V& b) {
  return a < b ? a : b;
}
template <typename V>
inline V larger(const V& a, const V& b) {
  return a > b ? a : b;
}
inline unsigned not_above(const FourFloats& a, const FourFloats& b) {
  const auto is = a <= b;
  unsigned bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    // Kept separate from the shift: in one expression, g++ 12 reads the wrong lane under -fsanitize=shift.
    const auto lane = static_cast<unsigned>(is[i] & 1);
    bits |= lane << i;
  }
  return bits;
}
#endif

inline TwoDoubles load_two(const double* lanes) {
  TwoDoubles v;
  __builtin_memcpy(&v, lanes, sizeof v);
  return v;
}

/// a and b, converted to single precision and concatenated.
inline FourFloats joined(const TwoDoubles& a, const TwoDoubles& b) {
#ifdef __SSE2__
  return _mm_movelh_ps(_mm_cvtpd_ps(a), _mm_cvtpd_ps(b));
#else
  return FourFloats{static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(b[0]),
                    static_cast<float>(b[1])};
#endif
}

/// Index of the lowest set bit; 64 if none is set.
inline unsigned lowest(std::uint64_t bits) {
#ifdef __BMI__
  return static_cast<unsigned>(_tzcnt_u64(bits));
#else
  return bits != 0 ? static_cast<unsigned>(__builtin_ctzll(bits)) : 64;
#endif
}

/// A mask of the lowest n bits, where n is the number of set bits in the argument, at most 4.
inline unsigned lowest_bits_mask(std::uint64_t bits) {
  const auto count = static_cast<unsigned>(__builtin_popcountll(bits));
#ifdef __BMI2__
  return _bzhi_u32(0xf, count);
#else
  return count < 4 ? (1u << count) - 1 : 0xf;
#endif
}

/// Bit k is set if a <= b, c <= d, e <= f and g <= h in lane k.
inline unsigned all_not_above(const Vector& a, const Vector& b, const Vector& c, const Vector& d,
                              const Vector& e, const Vector& f, const Vector& g, const Vector& h) {
#if SIDESTEP_VECTOR_WIDTH == 16
  const __mmask16 ab = _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ), ef = _mm512_cmp_ps_mask(e, f, _CMP_LE_OQ);
  return _kand_mask16(_mm512_mask_cmp_ps_mask(ab, c, d, _CMP_LE_OQ),
                      _mm512_mask_cmp_ps_mask(ef, g, h, _CMP_LE_OQ));
#elif SIDESTEP_VECTOR_WIDTH == 8
  const __m256 ab = _mm256_cmp_ps(a, b, _CMP_LE_OQ), cd = _mm256_cmp_ps(c, d, _CMP_LE_OQ);
  const __m256 ef = _mm256_cmp_ps(e, f, _CMP_LE_OQ), gh = _mm256_cmp_ps(g, h, _CMP_LE_OQ);
  return static_cast<unsigned>(
      _mm256_movemask_ps(_mm256_and_ps(_mm256_and_ps(ab, cd), _mm256_and_ps(ef, gh))));
#else
  return not_above(a, b) & not_above(c, d) & not_above(e, f) & not_above(g, h);
#endif
}

}  // namespace
}  // namespace sidestep::collision
