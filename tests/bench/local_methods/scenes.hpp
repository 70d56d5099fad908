// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/convex_polygon.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A regular octagon with this distance from its centre to its edges.
ConvexPolygon octagon(double inner_radius_m);

/// The points that a laser with `beams` beams over 360 degrees sees from the middle of a random room with
/// posts. No point is nearer than `nearest_m`.
std::vector<Vec2> laser_scan(Rng& rng, std::size_t beams, double nearest_m);

/// A winding corridor along the x axis.
struct Corridor {
  double length_m, half_width_m, amplitude_m, wave_m, phase_rad;

  static Corridor random(Rng& rng, double robot_radius_m, double length_m);
  Vec2 middle_m(double x_m) const;
  std::vector<Vec2> wall_points(std::size_t count) const;
  /// A path along the middle.
  std::vector<Vec2> path() const;
};

}  // namespace sidestep
