// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/image/image_error.hpp"

namespace sidestep {

/// An image with 8-bit samples R G B A, row by row from the top. Colours are not premultiplied by A.
struct RgbaImage {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> samples;
};

/// Decodes a PNG image of any kind; the bytes are untrusted. Samples are used as stored, so an image whose
/// gamma would change them is rejected. Samples of 16 bits are rounded to 8. Throws ImageError if the image
/// is truncated or damaged.
[[nodiscard]] RgbaImage decode_png(std::string_view bytes, const ImageSizeCheck& check_size);

/// Encodes 8-bit samples B G R as a PNG image. Throws ImageError if the image is empty or too large for PNG.
[[nodiscard]] std::string encode_png(const std::uint8_t* bgr, int width_px, int height_px,
                                     std::size_t row_bytes);

}  // namespace sidestep
