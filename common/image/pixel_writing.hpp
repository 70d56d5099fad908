// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/image/image.hpp"

namespace sidestep {

/// Writes pixels of R G B bytes down in a format. With kYuv422 two pixels share the mean of their u and v,
/// and the count is even.
void write_pixels(PixelFormat format, const std::uint8_t* rgb, int count, std::uint8_t* out);

/// The same image in a format. Precondition: it is kRgb, and its width is even when the format is kYuv422.
Image written_as(PixelFormat format, const ImageView& rgb);

}  // namespace sidestep
