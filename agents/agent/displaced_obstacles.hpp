// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "agents/agent/observed_obstacles.hpp"
#include "agents/safety/uncontrolled_body.hpp"
#include "common/protocol/negotiation_messages.hpp"

namespace sidestep {

/// Other robots that are not where their versions say, or that have fallen silent while driving, as reported
/// by the coordinator. It is unknown what moves them.
class DisplacedObstacles {
 public:
  /// A displaced robot that vision has not seen for longer than this is dropped, because by then it could be
  /// anywhere on half of the floor.
  static constexpr Duration kMaxObservationAge = ObservedObstacles::kMaxObservationAge;

  /// `margin_m` is the safety margin. `max_speed_mps` is an upper bound of a displaced robot's speed.
  /// `max_clock_difference` is an upper bound of the difference between the cameras' clock and the robot's.
  DisplacedObstacles(RobotId self, double radius_m, double margin_m, double max_speed_mps,
                     Duration max_clock_difference)
      : self_(self),
        radius_m_(radius_m),
        margin_m_(margin_m),
        max_speed_mps_(max_speed_mps),
        max_clock_difference_(max_clock_difference) {}

  /// Replaces all bodies with the bodies that the heartbeat reports at `now`.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);
  /// The bodies that vision has seen recently enough, for a robot that may lag by `max_lag` in excess of the
  /// clock bound. Valid until the next call.
  std::span<const UncontrolledBody> recent(Time now, Duration max_lag);

 private:
  RobotId self_;
  double radius_m_;
  double margin_m_;
  double max_speed_mps_;
  Duration max_clock_difference_;
  std::vector<UncontrolledBody> bodies_;
  std::vector<UncontrolledBody> recent_;  // result of recent() for a robot that may lag
};

}  // namespace sidestep
