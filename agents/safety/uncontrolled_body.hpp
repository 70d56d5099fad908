// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "agents/safety/moving_obstacle.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// A body that nothing controls, such as a robot without power. It may hit a resting robot, so passive safety
/// is not enough: a robot must not come to rest where the body is going.
struct UncontrolledBody {
  /// The positions that it can reach, and its expected velocity, which is finite; zero: it is at rest, or its
  /// velocity is unknown.
  MovingObstacle reach;
  double separation_m = 0;  ///< distance between centres at contact with the robot, plus the margin

  /// Distance of a position from the centre line of the body's path, which is straight and endless; if the
  /// velocity is zero, from the body.
  [[nodiscard]] double distance_from_path_m(const Vec2& position_m) const;
  /// Required distance from the centre line for a robot that rests at this position. It grows by a tenth of
  /// the distance from the body, because the direction is not exact.
  [[nodiscard]] double required_distance_m(const Vec2& position_m) const;
};

/// The minimum distance, less the required distance, between the body, moving as expected, and a robot that
/// follows the trajectory from `from` on and then rests. Negative: the body may touch the robot.
[[nodiscard]] double excess_distance_m(const Trajectory& trajectory, Time from, const UncontrolledBody& body);

/// Decides which candidates a robot may follow instead of `stop`. The constructor computes everything that
/// depends only on the stop.
class UncontrolledBodies {
 public:
  /// All candidates start at `start`. `stop` must not be null if there are bodies; there is at most one body
  /// per robot. `bodies` and `stop` must outlive this object.
  UncontrolledBodies(std::span<const UncontrolledBody> bodies, const Trajectory* stop, Time start);

  /// Whether, for every body, the candidate
  /// - rests off the body's path, or farther from its centre line than the stop does, by at least as much as
  ///   it rests nearer to the body, and
  /// - is at rest before the body could reach the robot (passive safety). If the body may touch the stopping
  ///   robot anyway, it suffices that the candidate leads out of the body's way, or at least farther from it,
  ///   when the robot then drives on for up to 0.4 s.
  [[nodiscard]] bool allow(const Trajectory& candidate, double min_separation_m,
                           double deceleration_mps2) const;

 private:
  std::span<const UncontrolledBody> bodies_;
  const Trajectory* stop_;
  std::array<double, kMaxRobots> stop_excess_m_;  ///< indexed by body: spare distance of the stop
};

}  // namespace sidestep
