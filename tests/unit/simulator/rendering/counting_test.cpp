// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "common/random/rng.hpp"
#include "simulator/rendering/counting/kernels.hpp"

using namespace sidestep;
using namespace sidestep::counting;

namespace {

Points random_points(Rng& rng) {
  Points points;
  const double x = rng.uniform(-0.12, 0.12), y = rng.uniform(-0.12, 0.12), size = rng.uniform(0.001, 0.02);
  for (std::size_t i = 0; i < kSamples; ++i) {
    points.x[i] = static_cast<float>(x + size * kSamplePattern.x[i]);
    points.y[i] = static_cast<float>(y + size * kSamplePattern.y[i]);
  }
  return points;
}

/// Steps along the line; whether a point of it lies well within the outline, and whether one is near it.
std::pair<bool, bool> slow_meets(double x, double y, double dx, double dy, const TrajectoryBounds& outline) {
  bool is_inside = false, is_near = false;
  for (int i = 0; i <= 1000; ++i) {
    const double px = x + dx * i / 1000, py = y + dy * i / 1000;
    const double out = std::max(std::hypot(px, py) - outline.radius, px - outline.front);
    is_inside = is_inside || out < -1e-4;
    is_near = is_near || out < 1e-4;
  }
  return {is_inside, is_near};
}

}  // namespace

TEST_CASE("all instruction sets count the same points") {
  const std::uint64_t seed = 81;
  CAPTURE(seed);
  Rng rng(seed);
  const Kernels& baseline = available_kernels().front();
  for (int i = 0; i < 20000; ++i) {
    const Points plain = random_points(rng), moved = rng.chance(0.5) ? plain : random_points(rng);
    const Pixel points{static_cast<float>(rng.uniform(-0.02, 0.02)),
                       static_cast<float>(rng.uniform(-0.02, 0.02)), &moved};
    const TrajectoryBounds outline{0.09F, rng.chance(0.5) ? 0.055F : 1e3F};
    const Lines lines{static_cast<float>(rng.uniform(0, 0.1)), static_cast<float>(rng.uniform(-3, 3)),
                      static_cast<float>(rng.uniform(-3, 3))};
    for (const Kernels& kernels : available_kernels()) {
      CAPTURE(kernels.name);
      REQUIRE(kernels.in_disc(points, 0.035F, 0.05F, 0.02F) ==
              baseline.in_disc(points, 0.035F, 0.05F, 0.02F));
      REQUIRE(kernels.in_outline(points, outline) == baseline.in_outline(points, outline));
      REQUIRE(kernels.on_lines(plain, points, lines, outline) ==
              baseline.on_lines(plain, points, lines, outline));
    }
  }
}

TEST_CASE("points are counted as one by one") {
  const std::uint64_t seed = 82;
  CAPTURE(seed);
  Rng rng(seed);
  const Kernels& kernels = best_kernels();
  for (int i = 0; i < 300; ++i) {
    const Points about = random_points(rng);
    const Pixel points{static_cast<float>(rng.uniform(-0.02, 0.02)),
                       static_cast<float>(rng.uniform(-0.02, 0.02)), &about};
    const TrajectoryBounds outline{0.09F, rng.chance(0.5) ? 0.055F : 1e3F};
    const Lines lines{static_cast<float>(rng.uniform(0.01, 0.1)), static_cast<float>(rng.uniform(-2, 2)),
                      static_cast<float>(rng.uniform(-2, 2))};
    int disc = 0, inside = 0, least = 0, most = 0;
    for (std::size_t j = 0; j < kSamples; ++j) {
      const double x = about.x[j] + points.x, y = about.y[j] + points.y;
      disc += std::hypot(x - 0.03, y + 0.05) <= 0.02;
      inside += std::hypot(x, y) <= 0.09 && x <= outline.front;
      const auto [is_inside, is_near] =
          slow_meets(x, y, lines.lean * (x - lines.foot_x), lines.lean * (y - lines.foot_y), outline);
      least += is_inside;
      most += is_near;
    }
    REQUIRE(std::abs(kernels.in_disc(points, 0.03F, -0.05F, 0.02F) - disc) <= 1);
    REQUIRE(std::abs(kernels.in_outline(points, outline) - inside) <= 1);
    const int met = kernels.on_lines(about, points, lines, outline);
    REQUIRE(met >= least);
    REQUIRE(met <= most);
  }
}

TEST_CASE("a pixel's points are spread evenly and lie about its centre") {
  for (const SampleAxis* axis : {&kSamplePattern.x, &kSamplePattern.y, &kSamplePattern.time}) {
    double sum = 0;
    std::vector<int> in_place(kSamples, 0);
    for (const float value : *axis) {
      sum += value;
      ++in_place.at(static_cast<std::size_t>((value + 0.5F) * kSamples));
    }
    CHECK(sum == Approx(0).margin(1e-6));
    for (const int count : in_place) CHECK(count == 1);
  }
}
