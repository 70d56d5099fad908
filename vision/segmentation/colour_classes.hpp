// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/image/image.hpp"
#include "vision/segmentation/batch/kernels.hpp"

namespace sidestep {

/// A pixel's brightness, and what it has more of blue and of red than that: for kYuv422 what the frame holds;
/// for kRgb, where thresholds of red, green and blue would not survive uneven light,
/// Y = ((R + B + 1) / 2 + G + 1) / 2, U = (B - Y + 256) / 2, V = (R - Y + 256) / 2, each rounded down.
struct Yuv {
  std::uint8_t y = 0;
  std::uint8_t u = 0;
  std::uint8_t v = 0;
  bool operator==(const Yuv&) const = default;
};

/// The pixel in column x and row y.
Yuv pixel_at(const ImageView& image, int x, int y);

/// A colour's pixels: all three numbers lie within low and high, both included.
struct ColourBox {
  Yuv low;
  Yuv high;
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
  /// Where boxes overlap, the first one counts. Precondition: at most kMaxColours.
  explicit ColourClasses(std::span<const ColourBox> boxes);

  std::span<const ColourBox> boxes() const { return boxes_; }
  /// Bit k: whether the pixel lies in box k.
  std::uint32_t bits(const Yuv& pixel) const { return y_[pixel.y] & u_[pixel.u] & v_[pixel.v]; }
  /// For the inner loops; valid as long as this is, and the thresholds.
  segmentation::ClassesView view(std::span<const segmentation::Thresholds> thresholds,
                                 const segmentation::Coarse& coarse) const {
    return {y_.data(), u_.data(), v_.data(), thresholds.data(), thresholds.size(), &coarse};
  }

 private:
  std::vector<ColourBox> boxes_;
  std::array<std::uint32_t, 256> y_{}, u_{}, v_{};
};

}  // namespace sidestep
