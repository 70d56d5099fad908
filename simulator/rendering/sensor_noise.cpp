// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/sensor_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/image/colour_space.hpp"

namespace sidestep {
namespace {

/// Size of the noise table: large enough that the sections of two rows seldom overlap, small enough for a
/// cache.
constexpr std::size_t kTableGroups = 1 << 16;

struct Noise {
  double r, g, b;
  double y() const { return bt601::kRed * r + bt601::kGreen * g + bt601::kBlue * b; }
};

std::int8_t rounded(double value) {
  return static_cast<std::int8_t>(std::clamp(std::lround(value), -127L, 127L));
}

void add_row(const std::uint8_t* __restrict clean, const std::int8_t* __restrict noise, std::size_t bytes,
             std::uint8_t* __restrict out) {
  for (std::size_t i = 0; i < bytes; ++i) {
    const auto sum = static_cast<std::int16_t>(clean[i] + noise[i]);
    const auto positive = std::max<std::int16_t>(sum, 0);
    out[i] = static_cast<std::uint8_t>(std::min<std::int16_t>(positive, 255));
  }
}

}  // namespace

SensorNoise::SensorNoise(PixelFormat format, double sd, int width_px, Rng& rng)
    : row_bytes_(ImageView{format, width_px, 1}.row_bytes()),
      group_bytes_(format == PixelFormat::kRgb ? 3 : 4),
      is_noiseless_(sd <= 0) {
  if (is_noiseless_) return;
  const auto sample = [&] {
    const double r = rng.normal(), g = rng.normal(), b = rng.normal();
    return Noise{sd * r, sd * g, sd * b};
  };
  while (noise_table_.size() < kTableGroups * group_bytes_ + row_bytes_) {
    const Noise a = sample();
    if (format == PixelFormat::kRgb) {
      noise_table_.insert(noise_table_.end(), {rounded(a.r), rounded(a.g), rounded(a.b)});
      continue;
    }
    const Noise b = sample();
    const double u = bt601::kU * (a.b + b.b - a.y() - b.y()) / 2,
                 v = bt601::kV * (a.r + b.r - a.y() - b.y()) / 2;
    noise_table_.insert(noise_table_.end(), {rounded(u), rounded(a.y()), rounded(v), rounded(b.y())});
  }
}

void SensorNoise::add(const std::uint8_t* clean, int rows, Rng& rng, std::uint8_t* out) const {
  if (is_noiseless_) {
    std::memcpy(out, clean, row_bytes_ * static_cast<std::size_t>(rows));
    return;
  }
  for (int y = 0; y < rows; ++y, clean += row_bytes_, out += row_bytes_)
    add_row(clean, noise_table_.data() + group_bytes_ * rng.below(kTableGroups), row_bytes_, out);
}

}  // namespace sidestep
