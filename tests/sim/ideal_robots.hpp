// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// Robots that follow their references exactly and obey the firmware's rules, and vision without errors, so
/// that a test covers the protocol alone.
class IdealRobots {
 public:
  IdealRobots(Bus& bus, const Scenario& scenario);

  Vec2 position_m(RobotId robot, Time t) { return state_at(robot, t).position_m; }
  Vec2 velocity_mps(RobotId robot, Time t) { return state_at(robot, t).velocity_mps; }
  /// Minimum distance between the edges of two robots at time t.
  double clearance_m(Time t);
  /// Sets how far the robot's clock is ahead of the bus's clock from now on.
  void set_clock_offset(RobotId robot, Duration offset) { robots_.at(robot).clock_offset = offset; }
  double radius_m() const { return radius_m_; }
  const Version& executing(RobotId robot, Time t);
  bool is_off_reference(RobotId robot) const { return robots_.at(robot).is_off_reference; }
  bool is_on_floor(RobotId robot) const { return !robots_.at(robot).is_lifted; }

  /// Displaces a robot and sets its velocity. The robot notices that it is off its reference, and makes an
  /// own stop.
  void push(RobotId robot, const Vec2& shift_m, const Vec2& velocity_mps, double inflation_m = 0);
  /// Restarts the robot's firmware, which keeps only the obeyed incarnation, epoch and version number.
  void reboot(RobotId robot) { push(robot, Vec2::Zero(), velocity_mps(robot, bus_.now())); }
  /// From now on the robot executes versions rounded to single precision.
  void round_versions(RobotId robot) { robots_.at(robot).rounds_versions = true; }
  void lift(RobotId robot);
  /// Requests to put a lifted robot down. It is on the floor once it executes a rest version.
  void place(RobotId robot, const Vec2& position_m);

 private:
  struct Robot {
    RobotId id = 0;
    Incarnation obeyed = 0;
    Epoch obeyed_epoch = 0;
    Duration clock_offset{0};
    std::optional<RobotReport::CommandEcho> last_command;
    Version executing;
    VersionNumber highest = 0;  // highest version number or incarnation received
    bool is_off_reference = false, is_lifted = false, has_moved = false;
    bool rounds_versions = false;
    std::vector<Version> pending;  // ascending by start
    Writer<msg::Feedback> writer;
  };
  State state_at(RobotId robot, Time t);
  void on_command(Robot& robot, const Command& command);
  void advance(Robot& robot, Time now);
  void report(Robot& robot);
  void report_periodically(Robot& robot);
  void publish_world();

  Bus& bus_;
  double radius_m_, deceleration_mps2_;
  Duration cycle_;
  std::map<RobotId, Robot> robots_;
  Writer<msg::WorldState> world_writer_;
  Writer<msg::ObstacleList> obstacle_writer_;
  Writer<msg::Disturbance> disturbance_writer_;
};

}  // namespace sidestep
