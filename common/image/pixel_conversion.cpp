// SPDX-License-Identifier: Apache-2.0
#include "common/image/pixel_conversion.hpp"

#include <cstring>

#include "common/image/colour_space.hpp"

namespace sidestep {
namespace {

/// BT.601 coefficients times 2^16. Those of y add up to 1, and those of u and of v to 0.
constexpr int kShift = 16;
constexpr int fixed(double value) {
  return static_cast<int>(value * (1 << kShift) + (value < 0 ? -0.5 : 0.5));
}
constexpr int kYRed = fixed(bt601::kRed), kYBlue = fixed(bt601::kBlue),
              kYGreen = (1 << kShift) - kYRed - kYBlue;
constexpr int kURed = fixed(-bt601::kU * bt601::kRed), kUGreen = fixed(-bt601::kU * bt601::kGreen);
constexpr int kUBlue = -kURed - kUGreen;
constexpr int kVGreen = fixed(-bt601::kV * bt601::kGreen), kVBlue = fixed(-bt601::kV * bt601::kBlue);
constexpr int kVRed = -kVGreen - kVBlue;

std::uint8_t luma(const std::uint8_t* c) {
  return static_cast<std::uint8_t>((kYRed * c[0] + kYGreen * c[1] + kYBlue * c[2] + (1 << (kShift - 1))) >>
                                   kShift);
}

/// The chroma of a pair of pixels, from the sum of their weighted channels.
std::uint8_t chroma(int sum) {
  const int value = 128 + ((sum + (1 << kShift)) >> (kShift + 1));
  return static_cast<std::uint8_t>(value > 255 ? 255 : value);
}

}  // namespace

void convert_pixels(PixelFormat format, const std::uint8_t* rgb, int count, std::uint8_t* out) {
  if (format == PixelFormat::kRgb) {
    std::memcpy(out, rgb, static_cast<std::size_t>(count) * 3);
    return;
  }
  for (int i = 0; i < count; i += 2, out += 4, rgb += 6) {
    const std::uint8_t *const a = rgb, *const b = rgb + 3;
    const int red = a[0] + b[0], green = a[1] + b[1], blue = a[2] + b[2];
    out[0] = chroma(kURed * red + kUGreen * green + kUBlue * blue);
    out[1] = luma(a);
    out[2] = chroma(kVRed * red + kVGreen * green + kVBlue * blue);
    out[3] = luma(b);
  }
}

Image converted_to(PixelFormat format, const ImageView& rgb) {
  Image image(format, rgb.width_px, rgb.height_px);
  convert_pixels(format, rgb.pixels, rgb.width_px * rgb.height_px, image.pixels());
  return image;
}

}  // namespace sidestep
