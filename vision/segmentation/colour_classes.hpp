// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/image/colour_space.hpp"
#include "common/image/image.hpp"
#include "vision/segmentation/batch/kernels.hpp"

namespace sidestep {

/// The values of a pixel to which thresholds apply. With kYuv422 they are the frame's values. With kRgb they
/// are computed, because thresholds on red, green and blue would not tolerate uneven light: Y = ((R + B + 1)
/// / 2 + G + 1) / 2, U = (B - Y + 256) / 2, V = (R - Y + 256) / 2, all rounded down. Precondition: column x
/// and row y exist.
Yuv pixel_at(const ImageView& image, int x, int y);

/// The pixels of a colour: all three values lie between low and high, inclusive. Precondition: no component
/// of low exceeds that of high.
struct ColourBox {
  Yuv low;
  Yuv high;
  std::uint32_t colour = 0;  ///< below kMaxColours; several boxes may share one
};

constexpr bool is_within(const ColourBox& box, const Yuv& pixel) {
  return box.low.y <= pixel.y && pixel.y <= box.high.y && box.low.u <= pixel.u && pixel.u <= box.high.u &&
         box.low.v <= pixel.v && pixel.v <= box.high.v;
}

inline constexpr std::size_t kMaxColours = segmentation::kMasks;

/// Classifies pixels by colour: each value is looked up in a table with one bit per box, and the three words
/// are combined by bitwise AND (CMVision; Bruce, CMU-CS-06-181, appendix A.1).
class ColourClasses {
 public:
  /// Where boxes overlap, the first one wins. Precondition: at most kMaxColours boxes.
  explicit ColourClasses(std::span<const ColourBox> boxes);

  std::span<const ColourBox> boxes() const { return boxes_; }
  /// Bit k is set if the pixel lies in box k.
  std::uint32_t bits(const Yuv& pixel) const { return y_[pixel.y] & u_[pixel.u] & v_[pixel.v]; }
  /// The colour of the first box that contains the pixel.
  [[nodiscard]] std::optional<std::uint32_t> colour_of(const Yuv& pixel) const {
    const std::uint32_t matches = bits(pixel);
    if (matches == 0) return std::nullopt;
    return boxes_[static_cast<std::size_t>(std::countr_zero(matches))].colour;
  }
  /// Indexed by value, the boxes whose range contains it: bit k for box k.
  std::span<const std::uint32_t, 256> y() const { return y_; }
  std::span<const std::uint32_t, 256> u() const { return u_; }
  std::span<const std::uint32_t, 256> v() const { return v_; }

 private:
  std::vector<ColourBox> boxes_;
  std::array<std::uint32_t, 256> y_{}, u_{}, v_{};
};

}  // namespace sidestep
