// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/batch/kernel_tables.hpp"

namespace sidestep::segmentation {
namespace {

struct RgbRow {
  const std::uint8_t* row;
  std::uint32_t bits(const ClassesView& classes, std::size_t x) const {
    const unsigned r = row[3 * x], g = row[3 * x + 1], b = row[3 * x + 2];
    const unsigned y = ((r + b + 1) / 2 + g + 1) / 2;
    return classes.y[y] & classes.u[(b + 256 - y) / 2] & classes.v[(r + 256 - y) / 2];
  }
};

struct Yuv422Row {
  const std::uint8_t* row;
  std::uint32_t bits(const ClassesView& classes, std::size_t x) const {
    const std::uint8_t* pair = row + x / 2 * 4;
    return classes.y[row[2 * x + 1]] & classes.u[pair[0]] & classes.v[pair[2]];
  }
};

/// Classifies a row by table look-up and bitwise AND, as in CMVision.
template <typename Row>
void classify(const ClassesView& classes, const std::uint8_t* row, std::size_t width_px,
              const RowMasks& masks) {
  const Row pixels{row};
  for (std::size_t word = 0; word * kWord < width_px; ++word) {
    const std::size_t begin = word * kWord;
    const std::size_t end = begin + kWord < width_px ? begin + kWord : width_px;
    std::uint64_t* by_colour = masks.by_colour + word * kMasks;
    std::uint64_t any = 0;
    for (std::size_t x = begin; x < end; ++x) {
      const std::uint32_t bits = pixels.bits(classes, x);
      if (bits == 0) continue;
      if (any == 0) {
        for (std::size_t colour = 0; colour < kMasks; ++colour) by_colour[colour] = 0;
      }
      const std::uint64_t bit = std::uint64_t{1} << (x - begin);
      any |= bit;
      by_colour[classes.thresholds[__builtin_ctz(bits)].colour] |= bit;
    }
    masks.any[word] = any;
  }
}

}  // namespace

const Kernels kBaselineKernels{"baseline", classify<RgbRow>, classify<Yuv422Row>};

}  // namespace sidestep::segmentation
