// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/image/image.hpp"

namespace sidestep {

/// Converts `count` pixels of R G B bytes to a format. With kYuv422 each pair of pixels shares the mean of
/// their u and v, and the count is even.
void convert_pixels(PixelFormat format, const std::uint8_t* rgb, int count, std::uint8_t* out);

/// Converts an image to a format. Precondition: the image is kRgb, and its width is even for kYuv422.
Image converted_to(PixelFormat format, const ImageView& rgb);

}  // namespace sidestep
