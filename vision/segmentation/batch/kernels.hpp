// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compiled once for each instruction set: must not contain inline functions, which linkers merge.
#include <cstddef>
#include <cstdint>

namespace sidestep::segmentation {

inline constexpr std::size_t kWord = 64;   ///< pixels per mask word
inline constexpr std::size_t kMasks = 32;  ///< maximum number of colours

/// A constant that fills the widest vector register.
struct alignas(64) VectorConstant {
  std::uint8_t bytes[64];
};

/// The thresholds of a box: the lowest value, and the span to the highest. Thresholds of U and V are also
/// stored interleaved, as in a frame.
struct Thresholds {
  VectorConstant y_low, y_span, u_low, u_span, v_low, v_span, uv_low, uv_span;
  std::uint32_t colour;
  std::uint32_t group;  ///< bit of the box's group in CoarseTables
};

/// Tables of the groups of boxes that may accept a value, indexed by its high nibble; bit k stands for group
/// k of eight. Each table has 16 bytes, repeated to fill a vector.
struct CoarseTables {
  VectorConstant y, u, v;
};

/// The colour classes in the formats that kernels use.
struct ClassesView {
  const std::uint32_t *y, *u, *v;  ///< indexed by value; bit k for box k
  const Thresholds* thresholds;    ///< indexed by box
  std::size_t boxes;
  std::uint32_t colours;  ///< bit c: colour c has a box
  const CoarseTables* coarse;
};

/// The colours of a row's pixels, in words of 64 pixels: bit i for pixel i. A pixel has at most one colour,
/// that of the first box that contains it.
struct RowMasks {
  std::uint64_t* any;        ///< indexed by word: pixels of any colour
  std::uint64_t* by_colour;  ///< by word and colour, kMasks per word; undefined where `any` is 0, and for
                             ///< colours without a box
};

using ClassifyRow = void (*)(const ClassesView& classes, const std::uint8_t* row, std::size_t width_px,
                             const RowMasks& masks);

/// The segmentation kernels of one instruction set.
struct Kernels {
  const char* name;
  ClassifyRow rgb, yuv422;
};

}  // namespace sidestep::segmentation
