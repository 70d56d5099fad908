// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/image/image.hpp"
#include "simulator/rendering/canvas.hpp"

namespace sidestep {

/// Writes RGB pixels down in a format. With kYuv422 two pixels share the mean of their u and v, and the count
/// is even.
void write_pixels(PixelFormat format, const cv::Vec3b* rgb, int count, std::uint8_t* out);

}  // namespace sidestep
