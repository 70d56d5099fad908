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

 private:
  struct Robot {
    RobotId id;
    Incarnation obeyed = 0;
    Epoch obeyed_epoch = 0;
    Duration clock_ahead{0};
    std::int64_t heard_stamp_ns = 0;  // of the obeyed agent's last command,
    Time heard_at{};                  // which came then
    Version executing;
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
  double radius_m_;
  Duration cycle_;
  std::map<RobotId, Robot> robots_;
  Writer<msg::WorldState> world_writer_;
};

}  // namespace sidestep
