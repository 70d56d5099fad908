// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A constant speed ahead (the x axis) and a constant turn rate, positive to the left. The robot follows an
/// arc, or a straight line without a turn rate.
struct ArcMotion {
  double speed_mps = 0, turn_rate_radps = 0;

  /// The motion along the same arc, backwards.
  ArcMotion reversed() const { return {-speed_mps, -turn_rate_radps}; }
};

/// The robot's displacement after a time, in the frame in which it starts.
[[nodiscard]] Vec2 displacement_m(const ArcMotion& motion, double seconds);

/// The position of a fixed point in the robot's frame after the robot has moved.
[[nodiscard]] Vec2 seen_after(const Vec2& point_m, const ArcMotion& motion, double seconds);

/// A point that crosses a line.
struct Crossing {
  double time_s = std::numeric_limits<double>::infinity();  ///< infinite: never
  Vec2 at_m{0, 0};                                          ///< in the robot's frame at that time
};

/// The first time at which a fixed point, seen from the robot, crosses a line in the direction opposite to
/// the line's normal. `offset_m` is the point's signed distance from the line, `normal` a unit vector.
/// Stable for any turn rate: with s = 2 tan(turn/2) / turn_rate, the distance vanishes where a quadratic in s
/// does, which becomes linear for straight motions.
[[nodiscard]] Crossing first_crossing(const Vec2& point_m, double offset_m, const Vec2& normal,
                                      const ArcMotion& motion);

}  // namespace sidestep
