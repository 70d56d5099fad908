// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/collision_problem.hpp"

#include <cmath>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

/// A random point in the unit square.
Vec2 sample_position(Rng& rng) {
  // y is drawn first, because the evaluation order of arguments is unspecified.
  const double y = rng.uniform(), x = rng.uniform();
  return {x, y};
}

/// The centre of one of `count` equal squares that divide the unit square.
Vec2 grid_position(std::size_t i, std::size_t count) {
  const auto columns = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(count))));
  const Vec2 square(static_cast<double>(i % columns), static_cast<double>(i / columns));
  return (square + Vec2(0.5, 0.5)) / static_cast<double>(columns);
}

/// A shape about as large as a circle with this radius.
Shape sample_shape(Rng& rng, const Vec2& at, double radius_m) {
  const double half_m = 0.88 * radius_m;
  switch (rng.below(4)) {
    case 0:
      return Box{at - Vec2(half_m, half_m), at + Vec2(half_m, half_m)};
    case 1:
      return Segment{at, at + rotated({3 * radius_m, 0}, rng.uniform(0, 6.283))};
    case 2: {
      ConvexPolygon polygon;
      for (int i = 0; i < 5; ++i) polygon.corners_m.push_back(at + rotated({1.1 * radius_m, 0}, i * 1.2566));
      return polygon;
    }
    default:
      return Circle{at, radius_m};
  }
}

}  // namespace

CollisionProblem::CollisionProblem(std::size_t obstacles, std::size_t motion_count, bool circles_only,
                                   std::uint64_t seed, ObstacleLayout layout) {
  Rng rng(seed);
  const double spacing_m = 1 / std::sqrt(static_cast<double>(obstacles));
  const double mean_radius_m = spacing_m * std::sqrt(kCovered / 3.14159265 / (13.0 / 12.0));
  radius_m = 0.08 * spacing_m;
  for (std::size_t i = 0; i < obstacles; ++i) {
    const Vec2 at = layout == ObstacleLayout::kGrid ? grid_position(i, obstacles) : sample_position(rng);
    const double size_m = mean_radius_m * rng.uniform(0.5, 1.5);
    shapes.push_back(circles_only ? Circle{at, size_m} : sample_shape(rng, at, size_m));
  }
  for (std::size_t i = 0; i < motion_count; ++i) {
    const Vec2 from = sample_position(rng);
    const double angle_rad = rng.uniform(0, 6.283), length_m = rng.uniform(0, 0.8) * spacing_m;
    motions.push_back({from, from + rotated({length_m, 0}, angle_rad)});
  }
}

}  // namespace sidestep
