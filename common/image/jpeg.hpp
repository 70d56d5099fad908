// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/image/image.hpp"
#include "common/image/image_error.hpp"

namespace sidestep {

/// Decodes a JPEG image in colour or grey as kRgb; the bytes are untrusted. The orientation in its Exif data
/// is ignored. Throws ImageError if the image is in CMYK, truncated or damaged.
[[nodiscard]] Image decode_jpeg(std::string_view bytes, const ImageSizeCheck& check_size);

/// Encodes 8-bit samples B G R as a JPEG image. Throws ImageError if the image is empty or too large for
/// JPEG.
[[nodiscard]] std::string encode_jpeg(const std::uint8_t* bgr, int width_px, int height_px,
                                      std::size_t row_bytes);

}  // namespace sidestep
