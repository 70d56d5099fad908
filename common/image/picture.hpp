// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "common/image/image.hpp"

namespace sidestep {

/// An image as OpenCV draws on it, and writes it.
cv::Mat3b bgr_of(const ImageView& image);

/// A PNG file, or what else OpenCV reads, as kRgb. Throws std::invalid_argument naming the file when it is
/// none.
Image read_picture(const std::string& path);

/// Throws std::runtime_error when the file cannot be written.
void write_png(const cv::Mat3b& bgr, const std::string& path);

}  // namespace sidestep
