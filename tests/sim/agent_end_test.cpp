// SPDX-License-Identifier: Apache-2.0
// Agents whose processes are asked to end while their robots drive.
#include "tests/catch.hpp"
#include "tests/sim/ideal_floor.hpp"
#include "tests/sim/shuttles.hpp"

namespace sidestep::agent_end_test {

TEST_CASE("a robot whose agent is asked to end rests when the agent ends, and the others drive on safely") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  IdealFloor floor(shuttles(4, 1, true), seed);
  REQUIRE(floor.run_until_speed(1.5));
  RobotId robot = 0;
  for (const RobotSpec& other : floor.scenario.robots)
    if (floor.speed_mps(other.id) > floor.speed_mps(robot)) robot = other.id;
  REQUIRE(floor.speed_mps(robot) >= 1.5);
  double waited_s = 0;
  for (; !floor.agent(robot).come_to_rest(); waited_s += 0.01) {
    REQUIRE(waited_s < 2);
    CHECK(floor.run(0.01) > 0);
  }
  CHECK(floor.speed_mps(robot) == 0);
  CHECK(floor.agent(robot).is_at_rest());
  floor.kill_agents(robot);
  for (int i = 0; i < 100; ++i) {
    CHECK(floor.run(0.02) > 0);
    CHECK(floor.speed_mps(robot) == 0);
  }
  CHECK(floor.run_until_speed(0.5));
  CHECK(floor.violations() == 0);
}

TEST_CASE("if all agents are asked to end, all robots come to rest within a version and a braking") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  IdealFloor floor(shuttles(4, 1, true), seed);
  REQUIRE(floor.run_until_speed(1.5));
  const auto have_finished = [&] {
    bool finished = true;
    for (const RobotSpec& robot : floor.scenario.robots)
      finished = floor.agent(robot.id).come_to_rest() && finished;
    return finished;
  };
  double waited_s = 0;
  for (; !have_finished(); waited_s += 0.01) {
    REQUIRE(waited_s < 2);
    CHECK(floor.run(0.01) > 0);
  }
  CHECK(floor.max_speed_mps() == 0);
  CHECK(floor.run(2) > 0);
  CHECK(floor.max_speed_mps() == 0);
  CHECK(floor.violations() == 0);
}

}  // namespace sidestep::agent_end_test
