// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {
namespace {

Yuv from_rgb(int r, int g, int b) {
  const int y = ((r + b + 1) / 2 + g + 1) / 2;
  return {static_cast<std::uint8_t>(y), static_cast<std::uint8_t>((b - y + 256) / 2),
          static_cast<std::uint8_t>((r - y + 256) / 2)};
}

}  // namespace

Yuv pixel_at(const ImageView& image, int x, int y) {
  const std::uint8_t* row = image.row(y);
  if (image.format == PixelFormat::kRgb) {
    const std::uint8_t* pixel = row + 3 * static_cast<std::ptrdiff_t>(x);
    return from_rgb(pixel[0], pixel[1], pixel[2]);
  }
  const std::uint8_t* pair = row + 4 * static_cast<std::ptrdiff_t>(x / 2);
  return {pair[x % 2 == 0 ? 1 : 3], pair[0], pair[2]};
}

ColourClasses::ColourClasses(std::span<const ColourBox> boxes) : boxes_(boxes.begin(), boxes.end()) {
  for (std::size_t k = 0; k < boxes_.size(); ++k) {
    const auto bit = std::uint32_t{1} << k;
    for (std::size_t value = 0; value < 256; ++value) {
      const ColourBox& box = boxes_[k];
      if (box.low.y <= value && value <= box.high.y) y_[value] |= bit;
      if (box.low.u <= value && value <= box.high.u) u_[value] |= bit;
      if (box.low.v <= value && value <= box.high.v) v_[value] |= bit;
    }
  }
}

}  // namespace sidestep
