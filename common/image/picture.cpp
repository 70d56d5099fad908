// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture.hpp"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>

#include "common/file/read_file.hpp"
#include "common/file/write_file.hpp"
#include "common/image/colour_space.hpp"
#include "common/image/picture_size.hpp"

namespace sidestep {
namespace {

cv::Vec3b bgr(const Rgb& colour) { return {colour.b, colour.g, colour.r}; }

/// Decodes a picture; empty if OpenCV cannot decode the bytes.
cv::Mat decoded(const std::string& bytes) {
  try {
    const cv::Mat file(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    return cv::imdecode(file, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    return {};  // discards OpenCV's message, which names its own source file
  }
}

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
  std::string bytes;
  try {
    bytes = read_file(path, kMaxPictureBytes);
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
  // OpenCV would allocate the size stated in the header, regardless of the file's content.
  const std::optional<PictureSize> size = stated_size(bytes);
  if (!size) throw std::invalid_argument(path + ": expected a picture in PNG, JPEG or PNM");
  if (size->width_px > kMaxPicturePixels || size->height_px > kMaxPicturePixels ||
      size->width_px * size->height_px > kMaxPicturePixels)
    throw std::invalid_argument(fmt::format("{}: a picture of {} x {} pixels, expected at most {} pixels",
                                            path, size->width_px, size->height_px, kMaxPicturePixels));
  const cv::Mat bgr = decoded(bytes);
  if (bgr.empty()) throw std::invalid_argument(path + ": the picture is damaged");
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
  std::vector<std::uint8_t> bytes;
  bool is_encoded = false;
  try {
    is_encoded = cv::imencode(".png", bgr, bytes);
  } catch (const cv::Exception&) {
    // Reported below, because OpenCV's message names its own source file.
  }
  if (!is_encoded) throw std::runtime_error("cannot write " + path + ": OpenCV cannot encode the picture");
  write_file(path, {bytes.begin(), bytes.end()});
}

}  // namespace sidestep
