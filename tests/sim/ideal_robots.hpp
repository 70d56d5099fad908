// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// Robots that follow their reference exactly and keep the firmware's rules, and a vision that sees them
/// exactly: what is left to test is the protocol.
class IdealRobots {
 public:
  IdealRobots(Bus& bus, const Scenario& scenario);

  Vec2 position_m(RobotId robot, Time t) { return state_at(robot, t).position_m; }
  Vec2 velocity_mps(RobotId robot, Time t) { return state_at(robot, t).velocity_mps; }
  /// The smallest distance between two robots' edges at a time.
  double clearance_m(Time t);
  /// From now on the robot's clock is ahead of the bus's by so much.
  void set_clock_ahead(RobotId robot, Duration ahead) { robots_.at(robot).clock_ahead = ahead; }
  double radius_m() const { return radius_m_; }
  /// What a robot executes at a time.
  const Version& executing(RobotId robot, Time t);
  bool is_off_reference(RobotId robot) const { return robots_.at(robot).is_off_reference; }
  bool is_on_floor(RobotId robot) const { return !robots_.at(robot).is_lifted; }

  /// Something moves a robot and gives it another velocity; it notices, and brakes.
  void push(RobotId robot, const Vec2& shift_m, const Vec2& velocity_mps, double inflation_m = 0);
  /// Its firmware starts again: it keeps what it has obeyed, and nothing else.
  void reboot(RobotId robot) { push(robot, Vec2::Zero(), velocity_mps(robot, bus_.now())); }
  void lift(RobotId robot);
  /// Wants to put a lifted robot down: as soon as it has taken a stand it stands there.
  void place(RobotId robot, const Vec2& place_m);

 private:
  struct Robot {
    RobotId id;
    Incarnation obeyed = 0;
    Epoch obeyed_epoch = 0;
    Duration clock_ahead{0};
    std::int64_t heard_stamp_ns = 0;  // of the obeyed agent's last command,
    Time heard_at{};                  // which came then
    Version executing;
    VersionNumber highest = 0;  // of all numbers and incarnations that came
    bool is_off_reference = false, is_lifted = false;
    std::vector<Version> pending;  // by start
    Writer<msg::Feedback> writer;
  };
  State state_at(RobotId robot, Time t);
  void on_command(Robot& robot, const msg::Command& command);
  void advance(Robot& robot, Time now);
  void report(Robot& robot);
  void report_periodically(Robot& robot);
  void publish_world();

  Bus& bus_;
  double radius_m_, deceleration_mps2_;
  Duration cycle_;
  std::map<RobotId, Robot> robots_;
  Writer<msg::WorldState> world_writer_;
  Writer<msg::Disturbance> hand_;
};

}  // namespace sidestep
