// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "agents/agent/observed_obstacles.hpp"
#include "agents/safety/uncontrolled_body.hpp"
#include "common/protocol/negotiation_messages.hpp"

namespace sidestep {

/// Other robots that are not where their versions say, or have fallen silent while they drive, as the
/// coordinator names them. What moves them is not known.
class DisplacedObstacles {
 public:
  /// A displaced robot that vision has lost for longer is dropped: by then its reach covers half a floor.
  static constexpr Duration kMaxObservationAge = ObservedObstacles::kMaxObservationAge;

  /// `margin_m`: the safety margin. `max_speed_mps`: upper bound of a displaced robot's speed.
  /// `max_clock_difference`: upper bound of the difference between the cameras' clock and the robot's.
  DisplacedObstacles(RobotId self, double radius_m, double margin_m, double max_speed_mps,
                     Duration max_clock_difference)
      : self_(self),
        radius_m_(radius_m),
        margin_m_(margin_m),
        max_speed_mps_(max_speed_mps),
        max_clock_difference_(max_clock_difference) {}

  /// Replaces all by those that the heartbeat names at `now`.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);
  /// Those that vision has not lost. Valid until the next call.
  std::span<const UncontrolledBody> recent(Time now);

 private:
  RobotId self_;
  double radius_m_;
  double margin_m_;
  double max_speed_mps_;
  Duration max_clock_difference_;
  std::vector<UncontrolledBody> bodies_;
};

}  // namespace sidestep
