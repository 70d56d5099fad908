// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/sensor_noise.hpp"

#include <cmath>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::sensor_noise_test {

struct Moments {
  double mean, sd;
};

/// The moments of every `step`-th byte, beginning at `first`.
Moments moments(const std::vector<std::uint8_t>& bytes, std::size_t first, std::size_t step) {
  double sum = 0, squares = 0, count = 0;
  for (std::size_t i = first; i < bytes.size(); i += step, ++count) {
    sum += bytes[i];
    squares += double(bytes[i]) * bytes[i];
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

/// Standard deviation after rounding to whole levels, which adds a variance of 1/12.
double rounded_sd(double sd) { return std::sqrt(sd * sd + 1.0 / 12); }

TEST_CASE("noise has the specified standard deviation in red, green and blue") {
  Rng rng(61);
  const SensorNoise noise(PixelFormat::kRgb, 2.5, 780, rng);
  const std::vector<std::uint8_t> clean(780 * 3 * 200, 100);
  std::vector<std::uint8_t> out(clean.size());
  noise.add(clean.data(), 200, rng, out.data());
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const Moments m = moments(out, channel, 3);
    CHECK(m.mean == Approx(100).margin(0.05));
    CHECK(m.sd == Approx(rounded_sd(2.5)).epsilon(0.02));
  }
}

TEST_CASE("YUV noise equals the converted RGB noise") {
  Rng rng(62);
  const SensorNoise noise(PixelFormat::kYuv422, 3, 780, rng);
  const std::vector<std::uint8_t> clean(780 * 2 * 300, 100);
  std::vector<std::uint8_t> out(clean.size());
  noise.add(clean.data(), 300, rng, out.data());
  const double y = 3 * std::hypot(0.299, 0.587, 0.114);
  const double u = 3 * std::hypot(0.168736, 0.331264, 0.5) / std::sqrt(2.0);
  const double v = 3 * std::hypot(0.5, 0.418688, 0.081312) / std::sqrt(2.0);
  const std::vector<double> expected{u, y, v, y};
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const Moments m = moments(out, channel, 4);
    CHECK(m.mean == Approx(100).margin(0.05));
    CHECK(m.sd == Approx(rounded_sd(expected[channel])).epsilon(0.02));
  }
}

TEST_CASE("noise is clamped at black and white") {
  Rng rng(63);
  const SensorNoise noise(PixelFormat::kRgb, 30, 100, rng);
  std::vector<std::uint8_t> clean(100 * 3 * 100), out(clean.size());
  for (std::size_t i = 0; i < clean.size(); ++i) clean[i] = i % 2 == 0 ? 2 : 253;
  noise.add(clean.data(), 100, rng, out.data());
  for (std::size_t i = 0; i < out.size(); ++i) {
    // Values never wrap around.
    if (i % 2 == 0) REQUIRE(out[i] < 200);
    if (i % 2 == 1) REQUIRE(out[i] > 55);
  }
}

TEST_CASE("the noise of different frames and rows is uncorrelated") {
  Rng rng(64);
  const int rows = 300, width = 780;
  const SensorNoise noise(PixelFormat::kRgb, 3, width, rng);
  const std::size_t bytes = width * 3;
  const std::vector<std::uint8_t> clean(bytes * rows, 128);
  std::vector<std::uint8_t> a(clean.size()), b(clean.size());
  noise.add(clean.data(), rows, rng, a.data());
  noise.add(clean.data(), rows, rng, b.data());
  double between_frames = 0, between_rows = 0;
  for (std::size_t i = 0; i + bytes < a.size(); ++i) {
    between_frames += (a[i] - 128.0) * (b[i] - 128.0);
    between_rows += (a[i] - 128.0) * (a[i + bytes] - 128.0);
  }
  // The mean of 700,000 products with a variance of 81 has a standard deviation of 0.011.
  CHECK(std::abs(between_frames / double(a.size())) < 0.05);
  CHECK(std::abs(between_rows / double(a.size())) < 0.05);
}

TEST_CASE("a frame without noise is unchanged") {
  Rng rng(65);
  const SensorNoise noise(PixelFormat::kYuv422, 0, 10, rng);
  std::vector<std::uint8_t> clean(10 * 2 * 5), out(clean.size());
  for (std::size_t i = 0; i < clean.size(); ++i) clean[i] = static_cast<std::uint8_t>(7 * i);
  noise.add(clean.data(), 5, rng, out.data());
  CHECK(out == clean);
}

}  // namespace sidestep::sensor_noise_test
