// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/vec2.hpp"
#include "tests/bench/crowds/half_plane_program.hpp"

namespace sidestep {

/// A convex obstacle as seen from a robot: its corners counter-clockwise, relative to the robot's centre, and
/// the distance that the robot's centre must keep from them and from the edges between them. One corner is a
/// disc, two are a wall.
struct RelativeObstacle {
  std::span<const Vec2> corners_m;
  double separation_m = 0;
};

/// The point of the obstacle that is nearest to the robot's centre, without the separation. It is the origin
/// if the robot's centre lies inside a polygon.
[[nodiscard]] Vec2 nearest_point_m(const RelativeObstacle& obstacle);

/// The velocity obstacle is the set of relative velocities at which the robot comes nearer than the
/// separation within `horizon_s` (van den Berg et al., Reciprocal n-body collision avoidance). It is convex.
/// Returns the half-plane outside of it whose boundary touches it at the velocity nearest to `velocity_mps`.
/// Precondition: the robot is farther away than the separation.
[[nodiscard]] HalfPlane outside_velocity_obstacle(const RelativeObstacle& obstacle, double horizon_s,
                                                  const Vec2& velocity_mps);

/// For two discs that are nearer than the separation: a half-plane of relative velocities at which they are
/// apart after `within_s`. Its boundary is as near to `velocity_mps` as possible.
[[nodiscard]] HalfPlane separating_velocities(const Vec2& offset_m, double separation_m, double within_s,
                                              const Vec2& velocity_mps);

}  // namespace sidestep
