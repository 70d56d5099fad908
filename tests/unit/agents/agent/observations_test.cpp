// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observations.hpp"

#include "common/config/scenario.hpp"
#include "common/protocol/obstacle_bounds.hpp"
#include "tests/catch.hpp"

namespace sidestep::observations_test {

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

/// A robot about which everything is known at kSet_s. Then its clock is set back by `back_s`.
struct SetBackRobot {
  static constexpr double kSet_s = 5000;
  FloorSpec floor;
  FloorRules rules{{6, 4}, {}, floor.limits};
  Observations observations{floor, RobotSpec{}, rules};
  double now_s = kSet_s;

  explicit SetBackRobot(double back_s) {
    observe();
    observations.on_obstacles({0, at_s(now_s), kCompleteEverywhere_m, {}}, at_s(now_s));
    compare();
    REQUIRE(wait_reason() == WaitReason::kNone);
    now_s -= back_s;
  }
  void observe() {
    WorldObservations world;
    world.valid_at = at_s(now_s);
    world.self = PoseFix{at_s(now_s), {0, 0}, 0};
    observations.on_world_state(world, at_s(now_s), true);
  }
  /// The coordinator compares the robots with their versions.
  void compare() {
    CoordinatorHeartbeat heartbeat;
    heartbeat.watched_until = at_s(now_s);
    observations.on_heartbeat(heartbeat, at_s(now_s));
  }
  WaitReason wait_reason() const { return observations.wait_reason(at_s(now_s)); }
  bool is_coordinator_without_vision() const {
    return observations.is_coordinator_without_vision(at_s(now_s));
  }
};

TEST_CASE("an observation of the robot from before its clock was set back is not recent") {
  SetBackRobot robot(GENERATE(0.005, 0.2, 5.0, 3000.0));
  CAPTURE(robot.now_s);
  CHECK(robot.wait_reason() == WaitReason::kNotSeen);
  robot.observe();
  CHECK(robot.wait_reason() != WaitReason::kNotSeen);
}

TEST_CASE("a list of obstacles from before the robot's clock was set back is not recent") {
  SetBackRobot robot(GENERATE(0.2, 5.0, 3000.0));
  CAPTURE(robot.now_s);
  robot.observe();
  CHECK(robot.wait_reason() == WaitReason::kNoObstacleList);
}

TEST_CASE("a list of obstacles may be ahead of the robot's clock as far as vision's clock may be") {
  SetBackRobot robot(0.09);
  robot.observe();
  robot.compare();
  CHECK(robot.wait_reason() == WaitReason::kNone);
}

TEST_CASE("a comparison by the coordinator from before the robot's clock was set back is not recent") {
  SetBackRobot robot(GENERATE(0.005, 0.2, 5.0, 3000.0));
  CAPTURE(robot.now_s);
  robot.observe();
  CHECK(robot.is_coordinator_without_vision());
  robot.compare();
  CHECK_FALSE(robot.is_coordinator_without_vision());
}

}  // namespace sidestep::observations_test
