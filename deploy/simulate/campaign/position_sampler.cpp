// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/position_sampler.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr int kMaxAttempts = 200;
constexpr double kExtraClearance_m = 0.01;

}  // namespace

bool PositionSampler::is_free(const Vec2& p) const {
  const double clearance_m = scenario_.radius_m + scenario_.margin_m + kExtraClearance_m;
  return scenario_.field.contains(p, clearance_m) &&
         std::ranges::none_of(
             scenario_.obstacles,
             [&](const Shape& obstacle) { return signed_distance(p, obstacle) < clearance_m; }) &&
         !(scenario_.map && scenario_.map->cells().touches(p, p, clearance_m));
}

bool PositionSampler::is_apart(const Vec2& p, const std::vector<Vec2>& others) const {
  const double separation_m = 2 * scenario_.radius_m + scenario_.margin_m + kExtraClearance_m;
  return std::ranges::none_of(others, [&](const Vec2& other) { return (p - other).norm() < separation_m; });
}

Vec2 PositionSampler::sample(double share) {
  for (int i = 0;; ++i) {
    const double part = i < kMaxAttempts ? share / 2 : 0.5;
    // y first: the order of arguments would be unspecified.
    const double y = rng_.uniform(-part, part) * scenario_.field.width_m;
    const double x = rng_.uniform(-part, part) * scenario_.field.length_m;
    const Vec2 p(x, y);
    if (is_free(p)) return p;
  }
}

Vec2 PositionSampler::sample_apart(const std::vector<Vec2>& others) {
  for (;;) {
    const Vec2 p = sample();
    if (is_apart(p, others)) return p;
  }
}

Vec2 PositionSampler::sample_near(const Vec2& desired, const std::vector<Vec2>& others) {
  for (int i = 0; i < kMaxAttempts; ++i) {
    const double spread = 0.005 * i;
    const double y = rng_.uniform(-spread, spread), x = rng_.uniform(-spread, spread);
    const Vec2 p = desired + Vec2(x, y);
    if (is_free(p) && is_apart(p, others)) return p;
  }
  return sample_apart(others);
}

}  // namespace sidestep
