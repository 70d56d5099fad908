// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sidestep {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

/// Full-range ITU-R BT.601; grey has u = v = 128.
struct Yuv {
  std::uint8_t y = 0, u = 128, v = 128;
  bool operator==(const Yuv&) const = default;
};

namespace bt601 {
/// The weights of red, green and blue in y.
inline constexpr double kRed = 0.299, kGreen = 0.587, kBlue = 0.114;
/// The scale of u relative to b - y, and of v relative to r - y.
inline constexpr double kU = 0.5 / (1 - kBlue), kV = 0.5 / (1 - kRed);
}  // namespace bt601

inline std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

inline Yuv yuv_of(const Rgb& c) {
  const double y = bt601::kRed * c.r + bt601::kGreen * c.g + bt601::kBlue * c.b;
  return {to_byte(y), to_byte(128 + bt601::kU * (c.b - y)), to_byte(128 + bt601::kV * (c.r - y))};
}

/// Colours outside the RGB range are clamped.
inline Rgb rgb_of(const Yuv& c) {
  const double r = c.y + (c.v - 128) / bt601::kV, b = c.y + (c.u - 128) / bt601::kU;
  return {to_byte(r), to_byte((c.y - bt601::kRed * r - bt601::kBlue * b) / bt601::kGreen), to_byte(b)};
}

}  // namespace sidestep
