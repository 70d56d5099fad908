// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "common/image/image.hpp"

namespace sidestep {

/// Copies an image into an OpenCV matrix.
cv::Mat3b bgr_of(const ImageView& image);

/// The number of pixels in the largest camera image that a scenario may have.
inline constexpr std::size_t kMaxPicturePixels = 4096 * 4096;
inline constexpr std::size_t kMaxPictureBytes = 64'000'000;

/// Reads a picture in PNG, JPEG, PGM or PPM as kRgb. Throws std::invalid_argument ("PATH: ...") if the file
/// does not exist, has another format, or exceeds kMaxPicturePixels or kMaxPictureBytes. The size stated in
/// its header is checked before memory is allocated for it.
Image read_picture(const std::string& path);

/// Writes a picture as write_file() does, and throws the same exceptions.
void write_png(const cv::Mat3b& bgr, const std::string& path);

/// Encodes a picture as JPEG. Throws ImageError if it is empty or too large for JPEG.
[[nodiscard]] std::string jpeg_of(const cv::Mat3b& bgr);

}  // namespace sidestep
