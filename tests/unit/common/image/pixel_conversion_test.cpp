// SPDX-License-Identifier: Apache-2.0
#include "common/image/pixel_conversion.hpp"

#include <cmath>

#include "common/image/colour_space.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::pixel_conversion_test {

TEST_CASE("a YUV image has each pixel's brightness and each pixel pair's mean colour") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  Rng rng(seed);
  Image rgb(PixelFormat::kRgb, 64, 32);
  for (std::size_t i = 0; i < rgb.view().bytes(); ++i)
    rgb.pixels()[i] = static_cast<std::uint8_t>(rng.below(256));
  const Image yuv = converted_to(PixelFormat::kYuv422, rgb.view());
  REQUIRE(yuv.view().width_px == 64);
  REQUIRE(yuv.view().height_px == 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; x += 2) {
      const std::uint8_t* const from = rgb.view().row(y) + std::ptrdiff_t{3} * x;
      const std::uint8_t* const pair = yuv.view().row(y) + std::ptrdiff_t{2} * x;
      const auto brightness = [](const std::uint8_t* c) {
        return bt601::kRed * c[0] + bt601::kGreen * c[1] + bt601::kBlue * c[2];
      };
      const double y0 = brightness(from), y1 = brightness(from + 3), mean = (y0 + y1) / 2;
      const double u = std::min(255.0, 128 + bt601::kU * ((from[2] + from[5]) / 2.0 - mean));
      const double v = std::min(255.0, 128 + bt601::kV * ((from[0] + from[3]) / 2.0 - mean));
      REQUIRE(std::abs(pair[0] - u) < 0.51);
      REQUIRE(std::abs(pair[1] - y0) < 0.51);
      REQUIRE(std::abs(pair[2] - v) < 0.51);
      REQUIRE(std::abs(pair[3] - y1) < 0.51);
    }
  }
}

TEST_CASE("converting an RGB image to RGB copies it") {
  Image rgb(PixelFormat::kRgb, 3, 2);
  for (std::size_t i = 0; i < 18; ++i) rgb.pixels()[i] = static_cast<std::uint8_t>(7 * i);
  const Image copy = converted_to(PixelFormat::kRgb, rgb.view());
  for (std::size_t i = 0; i < 18; ++i) CHECK(copy.view().pixels[i] == 7 * i);
}

}  // namespace sidestep::pixel_conversion_test
