// SPDX-License-Identifier: Apache-2.0
// Classification kernels for one instruction set; see vectors.hpp.
// Sources that include this must not include anything with inline functions: the linker keeps one copy of
// each, which may use instructions that the machine does not have.
#include "vision/segmentation/batch/vectors.hpp"

namespace sidestep::segmentation {
namespace {

/// Y, U and V of RGB pixels, one byte of a vector per pixel.
struct RgbPixels {
  static constexpr std::size_t kBytes = 3;  ///< per pixel
  Bytes y, u, v;
  explicit RgbPixels(const std::uint8_t* pixels) {
    Bytes r, g, b;
    split_rgb(pixels, r, g, b);
    y = average(average(r, b), g);
    const Bytes inverted_y = bit_not(y);
    u = average(b, inverted_y);
    v = average(r, inverted_y);
  }
  /// For each pixel, a bit for each group of boxes that may contain the pixel.
  Bytes groups(const CoarseTables& tables) const {
    return bit_and(bit_and(look_up(y, tables.y), look_up(u, tables.u)), look_up(v, tables.v));
  }
  /// The pixels within the thresholds: bit i for pixel i.
  std::uint64_t within(const Thresholds& t) const {
    return range_mask(y, t.y_low, t.y_span) & range_mask(u, t.u_low, t.u_span) &
           range_mask(v, t.v_low, t.v_span);
  }
};

struct Yuv422Pixels {
  static constexpr std::size_t kBytes = 2;
  Bytes y{}, uv{};
  explicit Yuv422Pixels(const std::uint8_t* pixels) { split_yuv422(pixels, y, uv); }
  Bytes groups(const CoarseTables& tables) const {
    return bit_and(look_up(uv, tables.u), odd_bytes(look_up(uv, tables.v)));
  }
  std::uint64_t within(const Thresholds& t) const {
    const std::uint64_t bits = range_mask(uv, t.uv_low, t.uv_span);
    const std::uint64_t pairs = bits & (bits >> 1) & 0x5555555555555555;
    return range_mask(y, t.y_low, t.y_span) & (pairs | pairs << 1);
  }
};

/// The pixels of one mask word: one or two vectors.
template <typename Pixels>
struct Word {
  static_assert(kWord == 2 * kWidth || kWord == kWidth);
  Pixels low, high;
  explicit Word(const std::uint8_t* row) : low(row), high(row + (kWord - kWidth) * Pixels::kBytes) {}
  Bytes groups(const CoarseTables& tables) const {
    if constexpr (kWord == kWidth) {
      return low.groups(tables);
    } else {
      return bit_or(low.groups(tables), high.groups(tables));
    }
  }
  std::uint64_t within(const Thresholds& t) const {
    if constexpr (kWord == kWidth) {
      return low.within(t);
    } else {
      return low.within(t) | high.within(t) << kWidth;
    }
  }
};

template <typename Pixels>
inline std::uint64_t classify_word(const ClassesView& classes, const std::uint8_t* row, std::uint64_t valid,
                                   std::uint64_t* by_colour) {
  const Word<Pixels> word(row);
  const Bytes possible_groups = word.groups(*classes.coarse);
  if (is_zero(possible_groups)) return 0;
  const unsigned groups = union_of_bytes(possible_groups);
  for (std::uint32_t left = classes.colours; left != 0; left &= left - 1) by_colour[__builtin_ctz(left)] = 0;
  std::uint64_t unclassified = valid;
  for (std::size_t k = 0; k < classes.boxes; ++k) {
    if ((classes.thresholds[k].group & groups) == 0) continue;
    const std::uint64_t found = word.within(classes.thresholds[k]) & unclassified;
    by_colour[classes.thresholds[k].colour] |= found;
    unclassified &= ~found;
  }
  return valid & ~unclassified;
}

template <typename Pixels>
void classify(const ClassesView& classes, const std::uint8_t* row, std::size_t width_px,
              const RowMasks& masks) {
  const std::size_t words = width_px / kWord, rest = width_px % kWord;
  for (std::size_t word = 0; word < words; ++word) {
    masks.any[word] = classify_word<Pixels>(classes, row + word * kWord * Pixels::kBytes, ~std::uint64_t{0},
                                            masks.by_colour + word * kMasks);
  }
  if (rest == 0) return;
  std::uint8_t last[kWord * Pixels::kBytes] = {};
  __builtin_memcpy(last, row + words * kWord * Pixels::kBytes, rest * Pixels::kBytes);
  masks.any[words] =
      classify_word<Pixels>(classes, last, (std::uint64_t{1} << rest) - 1, masks.by_colour + words * kMasks);
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_LEVEL, classify<RgbPixels>, classify<Yuv422Pixels>};

}  // namespace sidestep::segmentation
