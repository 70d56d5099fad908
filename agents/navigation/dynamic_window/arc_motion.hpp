// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// Motion with a constant speed ahead (along the x axis) and a constant turn rate, positive to the left. The
/// robot follows an arc, or a straight line if the turn rate is 0.
struct ArcMotion {
  double speed_mps = 0, turn_rate_radps = 0;

  /// The motion backwards along the same arc.
  ArcMotion reversed() const { return {-speed_mps, -turn_rate_radps}; }
};

/// The robot's displacement after a time, in the robot's frame at the start.
[[nodiscard]] Vec2 displacement_m(const ArcMotion& motion, double seconds);

/// The position of a fixed point in the robot's frame after the robot has moved.
[[nodiscard]] Vec2 point_after_motion(const Vec2& point_m, const ArcMotion& motion, double seconds);

/// The event that a point crosses a line.
struct Crossing {
  double time_s = std::numeric_limits<double>::infinity();  ///< infinite: the point never crosses the line
  /// Crossing point in the robot's frame at that time.
  Vec2 at_m{0, 0};
};

/// The first time at which a fixed point, seen from the robot, crosses a line in the direction opposite to
/// the line's normal. `offset_m` is the point's signed distance from the line, `normal` a unit vector.
/// Numerically stable for any turn rate: with s = 2 tan(turn/2) / turn_rate, the distance is zero where a
/// quadratic in s is zero, and this becomes linear for straight motions.
[[nodiscard]] Crossing first_crossing(const Vec2& point_m, double offset_m, const Vec2& normal,
                                      const ArcMotion& motion);

}  // namespace sidestep
