// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compiled once for each instruction set: nothing here may be an inline function that linkers merge.
#include <cstddef>
#include <cstdint>

namespace sidestep::segmentation {

inline constexpr std::size_t kWord = 64;   ///< pixels to a word of bits
inline constexpr std::size_t kMasks = 32;  ///< most colours

/// One byte, as often as any machine's vectors hold it.
struct alignas(64) Repeated {
  std::uint8_t bytes[64];
};

/// A box's thresholds: the lowest value, and how far above it the highest lies. Those of U and V stand
/// side by side too, as they do in a frame.
struct Thresholds {
  Repeated y_low, y_span, u_low, u_span, v_low, v_span, uv_low, uv_span;
  std::uint32_t colour;
  std::uint32_t group;  ///< the bit of Coarse that it belongs to
};

/// By a number's upper four bits, which of eight groups of boxes it may belong to: bit k for the k-th. Again
/// and again for each 16 bytes of a vector.
struct Coarse {
  Repeated y, u, v;
};

/// What colours a frame is searched for, as tables of bits by value, as thresholds, and as what most pixels
/// fail.
struct ClassesView {
  const std::uint32_t *y, *u, *v;
  const Thresholds* thresholds;
  std::size_t boxes;
  std::uint32_t colours;  ///< bit c: colour c is one of theirs
  const Coarse* coarse;
};

/// Which pixels of a row have which colour: by word of 64 pixels, bit i for the i-th. A pixel has one colour
/// at most: that of the first box that fits.
struct RowMasks {
  std::uint64_t* any;  ///< by word: pixels of any colour
  std::uint64_t* of;   ///< by word and colour, kMasks to a word; undefined where no pixel of the word has any
                       ///< colour, and for colours that no box has
};

using ClassifyRow = void (*)(const ClassesView& classes, const std::uint8_t* row, std::size_t width_px,
                             const RowMasks& masks);

/// The inner loops of segmentation for one instruction set.
struct Kernels {
  const char* name;
  ClassifyRow rgb, yuv422;
};

}  // namespace sidestep::segmentation
