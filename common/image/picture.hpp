// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "common/image/image.hpp"

namespace sidestep {

/// A copy of an image for OpenCV.
cv::Mat3b bgr_of(const ImageView& image);

/// Reads a PNG file, or any other format that OpenCV supports, as kRgb. Throws std::invalid_argument
/// ("PATH: ...") if there is no such file or it holds no image.
Image read_picture(const std::string& path);

/// Throws std::runtime_error if the file cannot be written.
void write_png(const cv::Mat3b& bgr, const std::string& path);

}  // namespace sidestep
