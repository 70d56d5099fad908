// SPDX-License-Identifier: Apache-2.0
// Vector operations for one instruction set. Included by sources compiled for it, after they define
// SIDESTEP_VECTOR_BYTES.
#include <immintrin.h>

#include "vision/segmentation/batch/kernels.hpp"

namespace sidestep::segmentation {
namespace {

constexpr std::size_t kWidth = SIDESTEP_VECTOR_BYTES;

#if SIDESTEP_VECTOR_BYTES == 64

typedef __m512i Bytes;

inline Bytes load(const std::uint8_t* bytes) { return _mm512_loadu_si512(bytes); }
inline Bytes average(Bytes a, Bytes b) { return _mm512_avg_epu8(a, b); }
inline Bytes bit_not(Bytes a) { return _mm512_ternarylogic_epi32(a, a, a, 0x55); }
inline Bytes bit_and(Bytes a, Bytes b) { return _mm512_and_si512(a, b); }
inline Bytes bit_or(Bytes a, Bytes b) { return _mm512_or_si512(a, b); }
inline bool is_zero(Bytes a) { return _mm512_test_epi8_mask(a, a) == 0; }
/// Looks up each byte's high nibble in a table of 16 entries.
inline Bytes look_up(Bytes a, const VectorConstant& table) {
  const Bytes index = bit_and(_mm512_srli_epi16(a, 4), _mm512_set1_epi8(0x0f));
  return _mm512_shuffle_epi8(load(table.bytes), index);
}
/// Moves each odd byte to the even position before it, and clears the odd ones.
inline Bytes odd_bytes(Bytes a) { return _mm512_srli_epi16(a, 8); }
/// Bit i is set if low <= byte i <= low + span.
inline std::uint64_t range_mask(Bytes a, const VectorConstant& low, const VectorConstant& span) {
  return _mm512_cmple_epu8_mask(_mm512_sub_epi8(a, load(low.bytes)), load(span.bytes));
}

/// Shuffle that selects every third byte of three consecutive vectors, starting with byte `first`. Bytes come
/// from the first two vectors, then from the last.
struct Deinterleave3 {
  alignas(64) std::uint8_t from[64];
  std::uint64_t is_last = 0;
  constexpr explicit Deinterleave3(int first) : from{} {
    for (int i = 0; i < 64; ++i) {
      const int at = 3 * i + first;
      from[i] = static_cast<std::uint8_t>(at % 128);
      if (at >= 128) is_last |= std::uint64_t{1} << i;
    }
  }
  Bytes of(Bytes a, Bytes b, Bytes c) const {
    const Bytes index = load(from);
    return _mm512_mask_permutexvar_epi8(_mm512_permutex2var_epi8(a, index, b), is_last, index, c);
  }
};
constexpr Deinterleave3 kRed(0), kGreen(1), kBlue(2);

/// Shuffle that selects every second byte of two consecutive vectors, starting with byte `first`.
struct Deinterleave2 {
  alignas(64) std::uint8_t from[64];
  constexpr explicit Deinterleave2(int first) : from{} {
    for (int i = 0; i < 64; ++i) from[i] = static_cast<std::uint8_t>(2 * i + first);
  }
  Bytes of(Bytes a, Bytes b) const { return _mm512_permutex2var_epi8(a, load(from), b); }
};
constexpr Deinterleave2 kChroma(0), kLuma(1);

inline void split_rgb(const std::uint8_t* pixels, Bytes& r, Bytes& g, Bytes& b) {
  const Bytes first = load(pixels), second = load(pixels + 64), third = load(pixels + 128);
  r = kRed.of(first, second, third);
  g = kGreen.of(first, second, third);
  b = kBlue.of(first, second, third);
}

inline void split_yuv422(const std::uint8_t* pixels, Bytes& y, Bytes& uv) {
  const Bytes first = load(pixels), second = load(pixels + 64);
  y = kLuma.of(first, second);
  uv = kChroma.of(first, second);
}

#else

typedef __m256i Bytes;

inline Bytes load(const std::uint8_t* bytes) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bytes));
}
inline Bytes average(Bytes a, Bytes b) { return _mm256_avg_epu8(a, b); }
inline Bytes bit_not(Bytes a) { return _mm256_xor_si256(a, _mm256_set1_epi8(-1)); }
inline Bytes bit_and(Bytes a, Bytes b) { return _mm256_and_si256(a, b); }
inline Bytes bit_or(Bytes a, Bytes b) { return _mm256_or_si256(a, b); }
inline bool is_zero(Bytes a) { return _mm256_testz_si256(a, a); }
/// Looks up each byte's high nibble in a table of 16 entries.
inline Bytes look_up(Bytes a, const VectorConstant& table) {
  const Bytes index = bit_and(_mm256_srli_epi16(a, 4), _mm256_set1_epi8(0x0f));
  return _mm256_shuffle_epi8(load(table.bytes), index);
}
/// Moves each odd byte to the even position before it, and clears the odd ones.
inline Bytes odd_bytes(Bytes a) { return _mm256_srli_epi16(a, 8); }
/// Bit i is set if low <= byte i <= low + span.
inline std::uint64_t range_mask(Bytes a, const VectorConstant& low, const VectorConstant& span) {
  const Bytes above_low = _mm256_sub_epi8(a, load(low.bytes));
  const Bytes is_within = _mm256_cmpeq_epi8(_mm256_min_epu8(above_low, load(span.bytes)), above_low);
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(is_within));
}

/// Shuffle that selects every third byte of three consecutive blocks of 16, starting with byte `first`, in
/// both halves of a vector.
struct Deinterleave3 {
  alignas(32) std::uint8_t from[3][32];
  constexpr explicit Deinterleave3(int first) : from{} {
    for (int i = 0; i < 32; ++i) {
      const int at = 3 * (i % 16) + first;
      for (int block = 0; block < 3; ++block) {
        from[block][i] = at / 16 == block ? static_cast<std::uint8_t>(at % 16) : std::uint8_t{0x80};
      }
    }
  }
  Bytes of(Bytes a, Bytes b, Bytes c) const {
    return _mm256_or_si256(
        _mm256_shuffle_epi8(a, load(from[0])),
        _mm256_or_si256(_mm256_shuffle_epi8(b, load(from[1])), _mm256_shuffle_epi8(c, load(from[2]))));
  }
};
constexpr Deinterleave3 kRed(0), kGreen(1), kBlue(2);

inline Bytes load_halves(const std::uint8_t* low, const std::uint8_t* high) {
  return _mm256_inserti128_si256(
      _mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(low))),
      _mm_loadu_si128(reinterpret_cast<const __m128i*>(high)), 1);
}

inline void split_rgb(const std::uint8_t* pixels, Bytes& r, Bytes& g, Bytes& b) {
  const Bytes first = load_halves(pixels, pixels + 48), second = load_halves(pixels + 16, pixels + 64),
              third = load_halves(pixels + 32, pixels + 80);
  r = kRed.of(first, second, third);
  g = kGreen.of(first, second, third);
  b = kBlue.of(first, second, third);
}

inline Bytes packed(Bytes low, Bytes high) {
  return _mm256_permute4x64_epi64(_mm256_packus_epi16(low, high), 0b11011000);
}

inline void split_yuv422(const std::uint8_t* pixels, Bytes& y, Bytes& uv) {
  const Bytes first = load(pixels), second = load(pixels + 32), low_byte = _mm256_set1_epi16(0xff);
  y = packed(_mm256_srli_epi16(first, 8), _mm256_srli_epi16(second, 8));
  uv = packed(_mm256_and_si256(first, low_byte), _mm256_and_si256(second, low_byte));
}

#endif

/// Bitwise OR of all bytes.
inline unsigned union_of_bytes(Bytes a) {
  unsigned long long bits = 0;
  for (std::size_t i = 0; i < kWidth / 8; ++i) bits |= static_cast<unsigned long long>(a[i]);
  bits |= bits >> 32;
  bits |= bits >> 16;
  return static_cast<unsigned>(bits | bits >> 8) & 0xff;
}

}  // namespace
}  // namespace sidestep::segmentation
