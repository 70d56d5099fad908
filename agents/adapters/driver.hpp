// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "common/protocol/drop_counters.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A velocity in the robot's own frame: x forward, y left.
struct BodyVelocity {
  Vec2 linear_mps{0, 0};
  double turn_radps = 0;
};

/// The commanded velocity of one robot until the next command, about 10 ms later.
struct BaseCommand {
  RobotId robot = 0;
  BodyVelocity velocity;
};

/// A base's pose according to its own measurement of its motion, in its odometry frame. Errors accumulate.
struct OdometryReport {
  RobotId robot = 0;
  Time measured_at{};
  Vec2 position_m{0, 0};
  double heading_rad = 0;
};

/// Connects robots to the hardware or software that moves them: it sends commands and receives the bases'
/// reports. All calls and callbacks are made in the thread of the process's bus. A base must stop by itself
/// soon after the last command.
class Driver {
 public:
  virtual ~Driver() = default;

  /// Sends the commands of all robots, once per control period.
  virtual void send(std::span<const BaseCommand> commands) = 0;
  /// Sets the callback for odometry. A driver without odometry never calls it. The driver checks that every
  /// report is finite and belongs to one of its robots. A report's time is the time that the base states,
  /// converted to the process's clock; DrivenRobot checks whether it is plausible.
  virtual void on_odometry(std::function<void(const OdometryReport&)> /*callback*/) {}
  /// Adds the driver's own drop counts.
  virtual void count_drops(DropCounters& drops) const { (void)drops; }
};

}  // namespace sidestep
