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

/// A pixel's brightness, and what it has more of blue and of red than that, as thresholds see it: for kYuv422
/// what the frame holds; for kRgb, where thresholds of red, green and blue would not survive uneven light, Y
/// = ((R + B + 1) / 2 + G + 1) / 2, U = (B - Y + 256) / 2, V = (R - Y + 256) / 2, each rounded down.
/// Precondition: the pixel in column x and row y exists.
Yuv pixel_at(const ImageView& image, int x, int y);

/// Pixels of a colour: all three numbers lie within low and high, both included. Precondition: none of low is
/// above high's.
struct ColourBox {
  Yuv low;
  Yuv high;
  std::uint32_t colour = 0;  ///< below kMaxColours; several boxes may belong to one
};

constexpr bool is_within(const ColourBox& box, const Yuv& pixel) {
  return box.low.y <= pixel.y && pixel.y <= box.high.y && box.low.u <= pixel.u && pixel.u <= box.high.u &&
         box.low.v <= pixel.v && pixel.v <= box.high.v;
}

inline constexpr std::size_t kMaxColours = segmentation::kMasks;

/// Which colour a pixel has: thresholds by look-up of each number in a table of bits, one for each colour,
/// and the bitwise AND of the three words (CMVision; Bruce, appendix A.2).
class ColourClasses {
 public:
  /// Where boxes overlap, the first one counts. Precondition: at most kMaxColours of them.
  explicit ColourClasses(std::span<const ColourBox> boxes);

  std::span<const ColourBox> boxes() const { return boxes_; }
  /// Bit k: whether the pixel lies in box k.
  std::uint32_t bits(const Yuv& pixel) const { return y_[pixel.y] & u_[pixel.u] & v_[pixel.v]; }
  /// That of the first box that the pixel lies in.
  std::optional<std::uint32_t> colour_of(const Yuv& pixel) const {
    const std::uint32_t found = bits(pixel);
    if (found == 0) return std::nullopt;
    return boxes_[static_cast<std::size_t>(std::countr_zero(found))].colour;
  }
  /// By number, which boxes have it within: bit k for box k.
  std::span<const std::uint32_t, 256> y() const { return y_; }
  std::span<const std::uint32_t, 256> u() const { return u_; }
  std::span<const std::uint32_t, 256> v() const { return v_; }

 private:
  std::vector<ColourBox> boxes_;
  std::array<std::uint32_t, 256> y_{}, u_{}, v_{};
};

}  // namespace sidestep
