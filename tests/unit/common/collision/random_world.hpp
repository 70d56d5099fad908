// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

inline Vec2 random_position(Rng& rng, double half_m) {
  return {rng.uniform(-half_m, half_m), rng.uniform(-half_m, half_m)};
}

inline Vec2 random_displacement(Rng& rng, double max_length_m) {
  const double angle_rad = rng.uniform(0, 6.28);
  return rotated(Vec2(rng.uniform(0, max_length_m), 0), angle_rad);
}

/// A polygon whose corners lie on an ellipse, so it is convex.
inline ConvexPolygon random_polygon(Rng& rng, const Vec2& centre, double size_m) {
  std::vector<double> angles(3 + rng.below(5));
  for (std::size_t i = 0; i < angles.size(); ++i)
    angles[i] = 6.28 * (static_cast<double>(i) + rng.uniform(0.1, 0.9)) / static_cast<double>(angles.size());
  const double aspect_ratio = rng.uniform(0.2, 1), turn_rad = rng.uniform(0, 3);
  ConvexPolygon polygon;
  for (const double angle : angles) {
    const Vec2 on_circle = size_m * Vec2(std::cos(angle), aspect_ratio * std::sin(angle));
    polygon.corners_m.push_back(centre + rotated(on_circle, turn_rad));
  }
  return polygon;
}

inline Shape random_shape(Rng& rng, double half_m, double size_m) {
  const Vec2 position = random_position(rng, half_m);
  switch (rng.below(4)) {
    case 0:
      return Circle{position, rng.uniform(0, size_m)};
    case 1: {
      const double width_m = rng.uniform(0, 2 * size_m), length_m = rng.uniform(0, 2 * size_m);
      return Box{position, position + Vec2(length_m, width_m)};
    }
    case 2:
      return random_polygon(rng, position, rng.uniform(0.1, 1) * size_m);
    default:
      return Segment{position, position + random_displacement(rng, 3 * size_m)};
  }
}

/// `count` shapes of all kinds. For any count they cover about a fifth of a square.
inline std::vector<Shape> random_shapes(Rng& rng, std::size_t count, double half_m) {
  const double size_m = 0.4 * 2 * half_m / std::sqrt(static_cast<double>(count) + 1);
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < count; ++i) shapes.push_back(random_shape(rng, half_m, size_m));
  return shapes;
}

/// The smallest distance from sampled points of a path to a shape; at most half a step above the exact
/// distance.
inline double sampled_distance(const Vec2& from, const Vec2& to, const Shape& shape, std::size_t steps) {
  double nearest = signed_distance(from, shape);
  for (std::size_t i = 1; i <= steps; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(steps);
    nearest = std::min(nearest, signed_distance(from + part * (to - from), shape));
  }
  return nearest;
}

}  // namespace sidestep
