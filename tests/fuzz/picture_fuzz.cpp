// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of pictures that users give to vision. libpng and TurboJPEG
// are not instrumented. OpenCV makes the seeds.
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "common/file/temporary_folder.hpp"
#include "common/image/picture.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {

bool try_input(View input) {
  static const TemporaryFolder folder;
  const std::string path = folder.file("picture");
  write_input(path, input);
  try {
    const Image image = read_picture(path);
    const ImageView view = image.view();
    SIDESTEP_REQUIRE(view.format == PixelFormat::kRgb && view.width_px > 0 && view.height_px > 0);
    SIDESTEP_REQUIRE(static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px) <=
                     kMaxPicturePixels);
    return true;
  } catch (const std::invalid_argument& error) {
    SIDESTEP_REQUIRE(std::string_view(error.what()).starts_with(path));
    return false;
  }
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> result;
  cv::Mat3b picture(9, 12);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      picture(y, x) = cv::Vec3b(static_cast<std::uint8_t>(20 * x), 90, static_cast<std::uint8_t>(25 * y));
  const auto add = [&](const char* extension, const std::vector<int>& settings) {
    Bytes& bytes = result.emplace_back();
    SIDESTEP_REQUIRE(cv::imencode(extension, picture, bytes, settings));
  };
  add(".png", {});
  add(".jpg", {});
  add(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  add(".ppm", {});
  add(".ppm", {cv::IMWRITE_PXM_BINARY, 0});
  return result;
}

}  // namespace sidestep::fuzz
