// SPDX-License-Identifier: Apache-2.0
// Histories that need a directed partition or a deaf agent, message by message: real agents' negotiation,
// real coordinators, real firmware. Each one brought two robots too near before robots fenced epochs.
#include <catch2/catch.hpp>

#include "agents/agent/negotiation.hpp"
#include "agents/safety/safety_search.hpp"
#include "common/messaging/codec.hpp"
#include "common/motion/clearance.hpp"
#include "coordinator/coordinator.hpp"
#include "simulator/firmware.hpp"

using namespace sidestep;

namespace {

constexpr Duration kCycle{16'666'667};

FloorRules floor_rules_here() {
  FloorRules rules;
  rules.field = {8, 8};
  return rules;
}

struct Robot {
  RobotId id;
  Firmware firmware;
  Robot(RobotId robot, Vec2 place) : id(robot), firmware(robot, place, 0, time_from_ns(1'000'000'000), {}) {}

  msg::Feedback fact(Time now) {
    auto feedback = firmware.feedback(now);
    feedback.head().sender(id);
    return feedback;
  }
  double rest_x() const { return firmware.executing().trajectory.rest_position_m().x(); }
  double speed_at(Time t) const { return firmware.executing().trajectory.state_at(t).velocity_mps.norm(); }
};

struct Driver {
  RobotId id;
  Negotiation negotiation;
  Driver(RobotId robot, Incarnation incarnation) : id(robot), negotiation(robot, incarnation, kCycle) {}

  template <typename Message>
  Message from_here(Message message) {
    message.robot(id);
    message.head().sender(id);
    message.head().incarnation(negotiation.incarnation());
    message.epoch(negotiation.epoch());
    return message;
  }
  /// Tells the robot who speaks and of which epoch, and hears its answer.
  void speak_to(Robot& robot, Time now) {
    robot.firmware.on_command(from_here(msg::Command()), now);
    negotiation.on_feedback(robot.fact(now));
  }
  void register_with(Coordinator& coordinator, Time now) {
    if (negotiation.needs_registration()) coordinator.on_registration(from_here(negotiation.registration()));
    negotiation.on_coordinator_state(coordinator.state(), now);
  }
  /// Drives the robot along x at a metre a second for some cycles, as far as it is allowed to.
  void drive(Coordinator& coordinator, Robot& robot, double direction, int cycles, Time& now) {
    for (int i = 0; i < cycles; ++i) {
      now += kCycle;
      coordinator.on_feedback(robot.fact(now));
      speak_to(robot, now);
      negotiation.on_coordinator_state(coordinator.state(), now);
      if (!negotiation.may_propose(now)) continue;
      const Time start = now + kCycle;
      const Version base = negotiation.base_at(start);
      const Vec2 desired(robot.speed_at(start) < 1 ? 2.9 * direction : 0, 0);
      const Trajectory candidate =
          accelerate_then_stop(start, base.trajectory.state_at(start), desired, kCycle, 5);
      const auto verdict =
          coordinator.on_proposal(from_here(negotiation.propose({&candidate, 1}, base.number, now)));
      const auto granted = verdict ? negotiation.on_verdict(*verdict, now + kCycle / 4) : std::nullopt;
      if (!granted) continue;
      auto command = from_here(msg::Command());
      command.has_version(true);
      command.granted(encode(*granted));
      robot.firmware.on_command(command, now + kCycle / 2);
    }
  }
  void rest(Coordinator& coordinator, Robot& robot, Time& now) {
    for (int i = 0; i < 60; ++i) {
      now += kCycle;
      coordinator.on_feedback(robot.fact(now));
      speak_to(robot, now);
    }
  }
};

/// Two robots a metre apart, their agents, and a coordinator that grants.
struct Floor {
  Time now = time_from_ns(2'000'000'000);
  Robot left{0, {0, 0}}, right{1, {1, 0}};
  Coordinator first{floor_rules_here(), {0, 1}, 100}, second{floor_rules_here(), {0, 1}, 200};
  Driver left_driver{0, 1000}, right_driver{1, 1000};

  Floor() {
    both_obey(first);
    REQUIRE(first.is_granting());
  }
  void both_obey(Coordinator& coordinator) {
    for (auto [driver, robot] : {std::pair{&left_driver, &left}, std::pair{&right_driver, &right}}) {
      driver->negotiation.on_coordinator_state(coordinator.state(), now);
      driver->speak_to(*robot, now);
      driver->register_with(coordinator, now);
    }
    left_driver.register_with(coordinator, now);
  }
  void require_clear() {
    const double keep = floor_rules_here().min_separation_m();
    REQUIRE(clearance_m(left.firmware.executing().trajectory, right.firmware.executing().trajectory, keep) >=
            0);
  }
};

}  // namespace

TEST_CASE("a restarted agent does not fall back to a coordinator that its robot has left") {
  Floor floor;
  floor.both_obey(floor.second);
  REQUIRE(floor.second.is_granting());
  floor.left_driver.drive(floor.second, floor.left, 1, 24, floor.now);
  floor.left_driver.rest(floor.second, floor.left, floor.now);
  REQUIRE(floor.left.rest_x() > 0.2);

  // The new agent hears the old coordinator first; that one has not heard of the new one.
  Driver heir(1, 2000);
  heir.speak_to(floor.right, floor.now);
  heir.negotiation.on_coordinator_state(floor.first.state(), floor.now);
  heir.register_with(floor.first, floor.now);
  heir.drive(floor.first, floor.right, -1, 60, floor.now);
  floor.require_clear();
  CHECK(floor.right.rest_x() == 1);

  // With the new coordinator it gets as near as it may.
  heir.negotiation.on_coordinator_state(floor.second.state(), floor.now);
  heir.register_with(floor.second, floor.now);
  heir.drive(floor.second, floor.right, -1, 60, floor.now);
  floor.require_clear();
  CHECK(floor.right.rest_x() < 0.9);
}

TEST_CASE("an agent that its robot does not obey any more cannot register for it in a new epoch") {
  Floor floor;
  Driver zombie = floor.left_driver;  // hears nothing of its robot from here on
  Driver heir(0, 2000);
  heir.speak_to(floor.left, floor.now);
  heir.negotiation.on_coordinator_state(floor.first.state(), floor.now);
  heir.speak_to(floor.left, floor.now);
  heir.register_with(floor.first, floor.now);
  heir.drive(floor.first, floor.left, 1, 24, floor.now);
  heir.rest(floor.first, floor.left, floor.now);
  REQUIRE(floor.left.rest_x() > 0.2);

  zombie.negotiation.on_coordinator_state(floor.second.state(), floor.now);
  floor.left.firmware.on_command(zombie.from_here(msg::Command()), floor.now);
  zombie.register_with(floor.second, floor.now);
  CHECK_FALSE(floor.second.is_granting());
  floor.right_driver.negotiation.on_coordinator_state(floor.second.state(), floor.now);
  floor.right_driver.speak_to(floor.right, floor.now);
  floor.right_driver.register_with(floor.second, floor.now);
  CHECK_FALSE(floor.second.is_granting());

  heir.negotiation.on_coordinator_state(floor.second.state(), floor.now);
  heir.speak_to(floor.left, floor.now);
  heir.register_with(floor.second, floor.now);
  CHECK(floor.second.is_granting());
  floor.right_driver.drive(floor.second, floor.right, -1, 60, floor.now);
  floor.require_clear();
  CHECK(floor.right.rest_x() < 0.9);
}
