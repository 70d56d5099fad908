// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture.hpp"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "common/file/read_file.hpp"
#include "common/image/colour_space.hpp"

namespace sidestep {
namespace {

cv::Vec3b bgr(const Rgb& colour) { return {colour.b, colour.g, colour.r}; }

}  // namespace

cv::Mat3b bgr_of(const ImageView& image) {
  cv::Mat3b picture(image.height_px, image.width_px);
  for (int y = 0; y < image.height_px; ++y) {
    const std::uint8_t* const bytes = image.row(y);
    for (int x = 0; x < image.width_px; ++x) {
      if (image.format == PixelFormat::kRgb) {
        const std::uint8_t* const rgb = bytes + std::ptrdiff_t{3} * x;
        picture(y, x) = {rgb[2], rgb[1], rgb[0]};
      } else {
        const std::uint8_t* const pair = bytes + std::ptrdiff_t{4} * (x / 2);
        picture(y, x) = bgr(rgb_of({bytes[2 * x + 1], pair[0], pair[2]}));
      }
    }
  }
  return picture;
}

Image read_picture(const std::string& path) {
  try {
    require_regular_file(path);
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  cv::Mat bgr;
  try {
    bgr = cv::imread(path, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    // Reported below, because OpenCV's message names its own source file.
  }
  if (bgr.empty()) throw std::invalid_argument(path + ": expected an image, such as a PNG file");
  Image image(PixelFormat::kRgb, bgr.cols, bgr.rows);
  for (int y = 0; y < bgr.rows; ++y) {
    std::uint8_t* out = image.row(y);
    for (int x = 0; x < bgr.cols; ++x, out += 3) {
      const auto& pixel = bgr.at<cv::Vec3b>(y, x);
      out[0] = pixel[2];
      out[1] = pixel[1];
      out[2] = pixel[0];
    }
  }
  return image;
}

void write_png(const cv::Mat3b& bgr, const std::string& path) {
  bool is_written = false;
  try {
    is_written = cv::imwrite(path, bgr);
  } catch (const cv::Exception&) {
    // Reported below, because OpenCV's message names its own source file.
  }
  if (!is_written) throw std::runtime_error("cannot write " + path);
}

}  // namespace sidestep
