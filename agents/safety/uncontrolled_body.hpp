// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "agents/safety/moving_obstacle.hpp"
#include "common/motion/version.hpp"

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

/// By how much more than required the body, if it moves as expected, stays away from a robot that follows the
/// trajectory from a time on and then rests. Negative: it may touch the robot.
[[nodiscard]] double spare_distance_m(const Trajectory& trajectory, Time from, const UncontrolledBody& body);

/// Which candidates a robot may follow that otherwise follows `stop`. What follows from the stop alone is
/// decided once, in the constructor.
class UncontrolledBodies {
 public:
  /// All candidates begin at `start`. `stop` is not null if there are bodies, of which there is at most one
  /// per robot. Both must outlive this object.
  UncontrolledBodies(std::span<const UncontrolledBody> bodies, const Trajectory* stop, Time start);

  /// Whether the candidate, with respect to every body,
  /// - rests beside the body's path, or farther out than the stop, by as much as it rests nearer to the body,
  /// and
  /// - is at rest before the body could reach the robot (passive safety), or, if the body may touch the robot
  ///   that stops, leads out of its way, or at least farther from it, if the robot then drives on for up to
  ///   0.4 s.
  [[nodiscard]] bool allow(const Trajectory& candidate, double min_separation_m,
                           double deceleration_mps2) const;

 private:
  std::span<const UncontrolledBody> bodies_;
  const Trajectory* stop_;
  std::array<double, kMaxRobots> stop_spare_m_;  ///< spare distance of the stop, by body
};

}  // namespace sidestep
