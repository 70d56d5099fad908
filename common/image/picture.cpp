// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "common/file/read_file.hpp"
#include "common/file/write_file.hpp"
#include "common/image/colour_space.hpp"
#include "common/image/jpeg.hpp"
#include "common/image/png.hpp"
#include "common/image/pnm.hpp"

namespace sidestep {
namespace {

using namespace std::string_view_literals;

cv::Vec3b bgr(const Rgb& colour) { return {colour.b, colour.g, colour.r}; }

void check_picture_size(long width_px, long height_px) {
  constexpr auto kMax = static_cast<long>(kMaxPicturePixels);
  if (width_px < 1 || height_px < 1) throw ImageError("the picture has no pixels");
  if (width_px > kMax || height_px > kMax || width_px * height_px > kMax)
    throw ImageError(
        fmt::format("a picture of {} x {} pixels, expected at most {} pixels", width_px, height_px, kMax));
}

Image without_alpha(const RgbaImage& rgba) {
  Image image(PixelFormat::kRgb, rgba.width_px, rgba.height_px);
  std::uint8_t* out = image.pixels();
  for (std::size_t i = 0; i < rgba.samples.size(); i += 4, out += 3)
    std::copy_n(rgba.samples.data() + i, 3, out);
  return image;
}

/// Samples are scaled to 0 to 255.
Image decode_pnm(const std::string& bytes) {
  std::istringstream file(bytes);
  PnmReader reader(file, check_picture_size);
  Image image(PixelFormat::kRgb, reader.width_px(), reader.height_px());
  const auto channels = static_cast<std::size_t>(reader.channels());
  std::vector<std::uint16_t> samples(channels * static_cast<std::size_t>(reader.width_px()));
  const int max = reader.max_sample();
  std::uint8_t* out = image.pixels();
  for (int y = 0; y < reader.height_px(); ++y) {
    reader.read_row(samples);
    for (std::size_t i = 0; i < samples.size(); i += channels)
      for (std::size_t channel = 0; channel < 3; ++channel)
        *out++ = static_cast<std::uint8_t>((samples[i + channel % channels] * 255 + max / 2) / max);
  }
  return image;
}

Image decoded(const std::string& bytes) {
  const std::string_view begin = std::string_view(bytes).substr(0, 2);
  if (begin == "\x89P"sv) return without_alpha(decode_png(bytes, check_picture_size));
  if (begin == "\xff\xd8"sv) return decode_jpeg(bytes, check_picture_size);
  if (begin == "P2" || begin == "P3" || begin == "P5" || begin == "P6") return decode_pnm(bytes);
  throw ImageError("expected a picture in PNG, JPEG, PGM or PPM");
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
  try {
    return decoded(bytes);
  } catch (const ImageError& error) {
    throw std::invalid_argument(fmt::format("{}: {}", path, error.what()));
  }
}

void write_png(const cv::Mat3b& bgr, const std::string& path) {
  std::string bytes;
  try {
    bytes = encode_png(bgr.data, bgr.cols, bgr.rows, bgr.step);
  } catch (const ImageError& error) {
    throw std::runtime_error(fmt::format("cannot write {}: {}", path, error.what()));
  }
  write_file(path, bytes);
}

std::string jpeg_of(const cv::Mat3b& bgr) { return encode_jpeg(bgr.data, bgr.cols, bgr.rows, bgr.step); }

}  // namespace sidestep
