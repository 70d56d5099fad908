// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "common/random/rng.hpp"
#include "simulator/rendering/coverage/kernels.hpp"
#include "tests/catch.hpp"

namespace sidestep::coverage_test {

using namespace sidestep::coverage;

Points random_points(Rng& rng) {
  Points points{};
  const double x = rng.uniform(-0.12, 0.12), y = rng.uniform(-0.12, 0.12), size = rng.uniform(0.001, 0.02);
  for (std::size_t i = 0; i < kSamples; ++i) {
    points.x[i] = static_cast<float>(x + size * kSamplePattern.x[i]);
    points.y[i] = static_cast<float>(y + size * kSamplePattern.y[i]);
  }
  return points;
}

/// Whether any point of a ray is well inside the cross-section, and whether any point is inside or near it.
std::pair<bool, bool> reference_hits(double x, double y, double dx, double dy, const CrossSection& section) {
  bool is_inside = false, is_near = false;
  for (int i = 0; i <= 1000; ++i) {
    const double px = x + dx * i / 1000, py = y + dy * i / 1000;
    const double out = std::max(std::hypot(px, py) - section.radius, px - section.front);
    is_inside = is_inside || out < -1e-4;
    is_near = is_near || out < 1e-4;
  }
  return {is_inside, is_near};
}

TEST_CASE("all instruction sets count the same samples") {
  const std::uint64_t seed = 81;
  CAPTURE(seed);
  Rng rng(seed);
  const Kernels& baseline = available_kernels().front();
  for (int i = 0; i < 20000; ++i) {
    const Points still = random_points(rng), moved = rng.chance(0.5) ? still : random_points(rng);
    const PixelSamples samples{static_cast<float>(rng.uniform(-0.02, 0.02)),
                               static_cast<float>(rng.uniform(-0.02, 0.02)), &moved};
    const CrossSection section{0.09F, rng.chance(0.5) ? 0.055F : 1e3F};
    const ViewingRays rays{static_cast<float>(rng.uniform(0, 0.1)), static_cast<float>(rng.uniform(-3, 3)),
                           static_cast<float>(rng.uniform(-3, 3))};
    for (const Kernels& kernels : available_kernels()) {
      CAPTURE(kernels.name);
      REQUIRE(kernels.count_in_disc(samples, 0.035F, 0.05F, 0.02F) ==
              baseline.count_in_disc(samples, 0.035F, 0.05F, 0.02F));
      REQUIRE(kernels.count_in_cross_section(samples, section) ==
              baseline.count_in_cross_section(samples, section));
      REQUIRE(kernels.count_rays_hitting(still, samples, rays, section) ==
              baseline.count_rays_hitting(still, samples, rays, section));
    }
  }
}

TEST_CASE("sample counts agree with a check of each sample") {
  const std::uint64_t seed = 82;
  CAPTURE(seed);
  Rng rng(seed);
  const Kernels& kernels = best_kernels();
  for (int i = 0; i < 300; ++i) {
    const Points offsets = random_points(rng);
    const PixelSamples samples{static_cast<float>(rng.uniform(-0.02, 0.02)),
                               static_cast<float>(rng.uniform(-0.02, 0.02)), &offsets};
    const CrossSection section{0.09F, rng.chance(0.5) ? 0.055F : 1e3F};
    const ViewingRays rays{static_cast<float>(rng.uniform(0.01, 0.1)), static_cast<float>(rng.uniform(-2, 2)),
                           static_cast<float>(rng.uniform(-2, 2))};
    int disc = 0, inside = 0, min_hits = 0, max_hits = 0;
    for (std::size_t j = 0; j < kSamples; ++j) {
      const double x = offsets.x[j] + samples.x, y = offsets.y[j] + samples.y;
      disc += std::hypot(x - 0.03, y + 0.05) <= 0.02;
      inside += std::hypot(x, y) <= 0.09 && x <= section.front;
      const auto [is_inside, is_near] = reference_hits(x, y, rays.parallax * (x - rays.nadir_x),
                                                       rays.parallax * (y - rays.nadir_y), section);
      min_hits += is_inside;
      max_hits += is_near;
    }
    REQUIRE(std::abs(kernels.count_in_disc(samples, 0.03F, -0.05F, 0.02F) - disc) <= 1);
    REQUIRE(std::abs(kernels.count_in_cross_section(samples, section) - inside) <= 1);
    const int hits = kernels.count_rays_hitting(offsets, samples, rays, section);
    REQUIRE(hits >= min_hits);
    REQUIRE(hits <= max_hits);
  }
}

TEST_CASE("a pixel's samples are evenly spread around its centre") {
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

}  // namespace sidestep::coverage_test
