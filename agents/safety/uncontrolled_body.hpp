// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "agents/safety/moving_obstacle.hpp"

namespace sidestep {

/// A body that nothing controls, such as a robot without power. It may hit a robot that rests, so passive
/// safety does not suffice: a robot must not come to rest where the body is going.
struct UncontrolledBody {
  MovingObstacle reach;     ///< where it can be
  Vec2 velocity_mps{0, 0};  ///< with which it is expected to move on; zero: it stands, or this is not known
  double separation_m = 0;  ///< of the centres at which it touches the robot, plus the margin

  /// Distance of a position from the middle of the body's path: straight on without end, or, if the velocity
  /// is zero, from the body.
  [[nodiscard]] double distance_from_path_m(const Vec2& position_m) const;
  /// Distance from the middle that a robot must keep which rests at this position. It grows by a tenth of
  /// the distance from the body, because the direction is not exact.
  [[nodiscard]] double required_distance_m(const Vec2& position_m) const;
};

/// Whether the body, if it moves as expected, never touches a robot that follows the trajectory from a time
/// on and then rests.
[[nodiscard]] bool avoids(const Trajectory& trajectory, Time from, const UncontrolledBody& body);

/// Whether a robot that otherwise follows `stop` may follow `candidate`. The candidate must
/// - rest beside the body's path, or farther out than the stop, by as much as it rests nearer to the body,
/// and
/// - be at rest before the body could reach the robot (passive safety), or, if the body would hit the robot
///   where it stops, lead out of its way if the robot then drives on for up to 0.4 s.
[[nodiscard]] bool may_follow(const Trajectory& candidate, const Trajectory* stop,
                              std::span<const UncontrolledBody> bodies, double min_separation_m,
                              double deceleration_mps2);

}  // namespace sidestep
