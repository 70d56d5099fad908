// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/agent/robot_laser.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// The corners that a robot with a laser cannot pass at any speed, because a person may appear from behind
/// them. Input: where and since when the robot has crept without making progress. Output: the corners that
/// routes avoid for a while.
class OccludedCorners {
 public:
  explicit OccludedCorners(double radius_m) : radius_m_(radius_m) {}

  /// How a robot approaches a corner.
  struct Approach {
    State at_start;            ///< the robot's state when its next motion starts
    Time start{};              ///< time at which that motion starts
    Vec2 waypoint_m{0, 0};     ///< next waypoint of the robot
    bool is_creeping = false;  ///< no speed is safe, so the robot creeps
  };
  /// Forgets old corners. Remembers the nearest corner ahead if the robot has crept near one place for a
  /// while, unless a person or another robot is at the corner, because these will leave. Returns whether it
  /// remembers a new corner.
  bool update(const Approach& approach, const RobotLaser& laser, Time now);
  /// Forgets everything, because the robot's clock was set back.
  void restart();

  /// The corner remembered last; nullopt if there is none.
  std::optional<Vec2> newest_m() const;
  template <typename Use>
  void for_each_corner_m(Use use) const {
    for (const Corner& corner : corners_) use(corner.at_m);
  }

 private:
  struct Corner {
    Vec2 at_m{0, 0};
    Time until{};  // time until which routes avoid the corner
  };
  /// A place at which no speed was safe, and the time since which the robot has not moved away from it.
  struct Standstill {
    Vec2 at_m{0, 0};
    Time since{};
  };
  /// Measures how long the robot has crept near one place. Returns whether the full time has passed; the
  /// measurement then starts over.
  bool measure_standstill(const Approach& approach, Time now);
  /// The nearest place ahead of the robot where a person may appear.
  std::optional<Vec2> corner_ahead_m(const Approach& approach, const HiddenSpace& hidden) const;
  /// Whether a person or another robot is at the corner.
  bool is_body(const Vec2& corner_m, const RobotLaser& laser) const;

  double radius_m_;  // of the robot
  std::optional<Standstill> standstill_;
  std::vector<Corner> corners_;
};

}  // namespace sidestep
