// SPDX-License-Identifier: Apache-2.0
// Included by sources that are compiled for one instruction set. They must not include anything that has
// inline functions: the linker would keep one copy, perhaps that of an instruction set which the machine does
// not have.
#include "vision/segmentation/batch/vectors.hpp"

namespace sidestep::segmentation {
namespace {

/// As many pixels as a vector holds, by number.
struct RgbPixels {
  static constexpr std::size_t kBytes = 3;  ///< of a pixel
  Bytes y, u, v;
  explicit RgbPixels(const std::uint8_t* pixels) {
    Bytes r, g, b;
    split_rgb(pixels, r, g, b);
    y = average(average(r, b), g);
    const Bytes dark = inverted(y);
    u = average(b, dark);
    v = average(r, dark);
  }
  /// The groups of boxes that pixels may lie in, somewhere in their bytes.
  Bytes groups(const Coarse& c) const { return both(both(coarse(y, c.y), coarse(u, c.u)), coarse(v, c.v)); }
  std::uint64_t of(const Thresholds& t) const {
    return within(y, t.y_low, t.y_span) & within(u, t.u_low, t.u_span) & within(v, t.v_low, t.v_span);
  }
};

struct Yuv422Pixels {
  static constexpr std::size_t kBytes = 2;
  Bytes y, uv;
  explicit Yuv422Pixels(const std::uint8_t* pixels) { split_yuv422(pixels, y, uv); }
  Bytes groups(const Coarse& c) const { return both(coarse(uv, c.u), second_of_pairs(coarse(uv, c.v))); }
  std::uint64_t of(const Thresholds& t) const {
    const std::uint64_t bits = within(uv, t.uv_low, t.uv_span);
    const std::uint64_t pairs = bits & (bits >> 1) & 0x5555555555555555;
    return within(y, t.y_low, t.y_span) & (pairs | pairs << 1);
  }
};

/// The pixels of one word.
template <typename Pixels>
struct Word {
  static_assert(kWord == 2 * kWidth || kWord == kWidth);
  Pixels low, high;
  explicit Word(const std::uint8_t* row) : low(row), high(row + (kWord - kWidth) * Pixels::kBytes) {}
  Bytes groups(const Coarse& c) const {
    if constexpr (kWord == kWidth) {
      return low.groups(c);
    } else {
      return either(low.groups(c), high.groups(c));
    }
  }
  std::uint64_t of(const Thresholds& t) const {
    if constexpr (kWord == kWidth) {
      return low.of(t);
    } else {
      return low.of(t) | high.of(t) << kWidth;
    }
  }
};

template <typename Pixels>
inline std::uint64_t classify_word(const ClassesView& classes, const std::uint8_t* row, std::uint64_t valid,
                                   std::uint64_t* of) {
  const Word<Pixels> word(row);
  const Bytes may_have = word.groups(*classes.coarse);
  if (is_zero(may_have)) return 0;
  const unsigned groups = united(may_have);
  for (std::uint32_t left = classes.colours; left != 0; left &= left - 1) of[__builtin_ctz(left)] = 0;
  std::uint64_t left = valid;
  for (std::size_t k = 0; k < classes.boxes; ++k) {
    if ((classes.thresholds[k].group & groups) == 0) continue;
    const std::uint64_t found = word.of(classes.thresholds[k]) & left;
    of[classes.thresholds[k].colour] |= found;
    left &= ~found;
  }
  return valid & ~left;
}

template <typename Pixels>
void classify(const ClassesView& classes, const std::uint8_t* row, std::size_t width_px,
              const RowMasks& masks) {
  const std::size_t words = width_px / kWord, rest = width_px % kWord;
  for (std::size_t word = 0; word < words; ++word) {
    masks.any[word] = classify_word<Pixels>(classes, row + word * kWord * Pixels::kBytes, ~std::uint64_t{0},
                                            masks.of + word * kMasks);
  }
  if (rest == 0) return;
  std::uint8_t last[kWord * Pixels::kBytes] = {};
  __builtin_memcpy(last, row + words * kWord * Pixels::kBytes, rest * Pixels::kBytes);
  masks.any[words] =
      classify_word<Pixels>(classes, last, (std::uint64_t{1} << rest) - 1, masks.of + words * kMasks);
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_LEVEL, classify<RgbPixels>, classify<Yuv422Pixels>};

}  // namespace sidestep::segmentation
