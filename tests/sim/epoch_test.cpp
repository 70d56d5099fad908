// SPDX-License-Identifier: Apache-2.0
// Sequences of single messages between the real negotiation of agents, coordinators and firmware, with a
// one-way partition or an agent that receives nothing. If robots did not fence epochs, each sequence would
// bring two robots too close together.
#include "agents/agent/negotiation.hpp"
#include "agents/safety/safety_search.hpp"
#include "common/messaging/negotiation_codec.hpp"
#include "common/motion/clearance.hpp"
#include "common/protocol/senders.hpp"
#include "coordinator/coordinator.hpp"
#include "simulator/world/firmware.hpp"
#include "tests/catch.hpp"

namespace sidestep::epoch_test {

constexpr Duration kCycle{16'666'667};

FloorRules test_floor_rules() {
  FloorRules rules;
  rules.field = {8, 8};
  return rules;
}

struct Robot {
  Firmware firmware;
  Robot(RobotId robot, Vec2 position) : firmware(robot, position, 0, time_from_ns(1'000'000'000), {}) {}

  RobotReport robot_report(Time now) { return firmware.robot_report(now); }
  double rest_x() const { return firmware.executing().trajectory.rest_position_m().x(); }
  double speed_at(Time t) const { return firmware.executing().trajectory.state_at(t).velocity_mps.norm(); }
};

struct Driver {
  RobotId id;
  Negotiation negotiation;
  Driver(RobotId robot, Incarnation incarnation) : id(robot), negotiation(robot, incarnation, kCycle) {}

  /// A command with the agent's incarnation and epoch.
  Command command() const {
    Command command;
    command.robot = id;
    command.incarnation = negotiation.incarnation();
    command.epoch = negotiation.epoch();
    return command;
  }
  /// Sends the robot a command without a version, and processes its report.
  void fence(Robot& robot, Time now) {
    robot.firmware.on_command(command(), now);
    negotiation.on_robot_report(robot.robot_report(now));
  }
  void receive_heartbeat(const Coordinator& coordinator, Time now) {
    msg::CoordinatorState state = coordinator.state();
    state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
    const auto heartbeat = decode(state, now);
    REQUIRE(heartbeat);
    negotiation.on_coordinator_state(*heartbeat, now);
  }
  void register_with(Coordinator& coordinator, Time now) {
    if (negotiation.needs_registration()) coordinator.on_registration(negotiation.registration());
    receive_heartbeat(coordinator, now);
  }
  /// Proposes to drive along x at up to 1 m/s for some cycles, and executes the versions that are granted.
  void drive(Coordinator& coordinator, Robot& robot, double direction, int cycles, Time& now) {
    for (int i = 0; i < cycles; ++i) {
      now += kCycle;
      coordinator.on_robot_report(robot.robot_report(now), now);
      fence(robot, now);
      receive_heartbeat(coordinator, now);
      if (!negotiation.may_propose(now)) continue;
      const Time start = now + kCycle;
      const Version base = negotiation.held().base_at(start);
      const Vec2 desired(robot.speed_at(start) < 1 ? 2.9 * direction : 0, 0);
      const Trajectory candidate =
          accelerate_then_stop(start, base.trajectory.state_at(start), desired, kCycle, 5);
      const auto verdict = coordinator.on_proposal(negotiation.propose({&candidate, 1}, base.number, now));
      if (!verdict) continue;
      const std::optional<Version> granted = negotiation.on_verdict(*verdict, now + kCycle / 4).granted;
      if (!granted) continue;
      Command forward = command();
      forward.version = granted;
      robot.firmware.on_command(forward, now + kCycle / 2);
    }
  }
  void rest(Coordinator& coordinator, Robot& robot, Time& now) {
    for (int i = 0; i < 60; ++i) {
      now += kCycle;
      coordinator.on_robot_report(robot.robot_report(now), now);
      fence(robot, now);
    }
  }
};

/// Two robots 1 m apart, their agents, a coordinator that grants and a second one.
struct Floor {
  Time now = time_from_ns(2'000'000'000);
  Robot left{0, {0, 0}}, right{1, {1, 0}};
  Coordinator first{test_floor_rules(), {0, 1}, 100}, second{test_floor_rules(), {0, 1}, 200};
  Driver left_driver{0, 1000}, right_driver{1, 1000};

  Floor() {
    both_obey(first);
    REQUIRE(first.is_granting());
  }
  void both_obey(Coordinator& coordinator) {
    for (auto [driver, robot] : {std::pair{&left_driver, &left}, std::pair{&right_driver, &right}}) {
      driver->receive_heartbeat(coordinator, now);
      driver->fence(*robot, now);
      driver->register_with(coordinator, now);
    }
    left_driver.register_with(coordinator, now);
  }
  void require_clear() {
    const double separation = test_floor_rules().min_separation_m();
    REQUIRE(clearance_m(left.firmware.executing().trajectory, right.firmware.executing().trajectory,
                        separation) >= 0);
  }
};

TEST_CASE(
    "a restarted agent does not register with an old coordinator after its robot has obeyed a newer "
    "coordinator") {
  Floor floor;
  floor.both_obey(floor.second);
  REQUIRE(floor.second.is_granting());
  floor.left_driver.drive(floor.second, floor.left, 1, 24, floor.now);
  floor.left_driver.rest(floor.second, floor.left, floor.now);
  REQUIRE(floor.left.rest_x() > 0.2);

  // The new agent first receives heartbeats of the old coordinator, which does not know about the new
  // coordinator.
  Driver successor(1, 2000);
  successor.fence(floor.right, floor.now);
  successor.receive_heartbeat(floor.first, floor.now);
  successor.register_with(floor.first, floor.now);
  successor.drive(floor.first, floor.right, -1, 60, floor.now);
  floor.require_clear();
  CHECK(floor.right.rest_x() == 1);

  // Under the new coordinator the robot approaches the other robot up to the required separation.
  successor.receive_heartbeat(floor.second, floor.now);
  successor.register_with(floor.second, floor.now);
  successor.drive(floor.second, floor.right, -1, 60, floor.now);
  floor.require_clear();
  CHECK(floor.right.rest_x() < 0.9);
}

TEST_CASE("an agent whose robot obeys a later agent cannot register in a new epoch") {
  Floor floor;
  Driver fenced_agent = floor.left_driver;  // its agent receives no further reports
  Driver successor(0, 2000);
  successor.fence(floor.left, floor.now);
  successor.receive_heartbeat(floor.first, floor.now);
  successor.fence(floor.left, floor.now);
  successor.register_with(floor.first, floor.now);
  successor.drive(floor.first, floor.left, 1, 24, floor.now);
  successor.rest(floor.first, floor.left, floor.now);
  REQUIRE(floor.left.rest_x() > 0.2);

  fenced_agent.receive_heartbeat(floor.second, floor.now);
  floor.left.firmware.on_command(fenced_agent.command(), floor.now);
  fenced_agent.register_with(floor.second, floor.now);
  CHECK_FALSE(floor.second.is_granting());
  floor.right_driver.receive_heartbeat(floor.second, floor.now);
  floor.right_driver.fence(floor.right, floor.now);
  floor.right_driver.register_with(floor.second, floor.now);
  CHECK_FALSE(floor.second.is_granting());

  successor.receive_heartbeat(floor.second, floor.now);
  successor.fence(floor.left, floor.now);
  successor.register_with(floor.second, floor.now);
  CHECK(floor.second.is_granting());
  floor.right_driver.drive(floor.second, floor.right, -1, 60, floor.now);
  floor.require_clear();
  CHECK(floor.right.rest_x() < 0.9);
}

}  // namespace sidestep::epoch_test
