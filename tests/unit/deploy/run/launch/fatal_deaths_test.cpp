// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/fatal_deaths.hpp"

#include "tests/catch.hpp"

namespace sidestep::fatal_deaths_test {
namespace {

/// Robots 0, 1 and 2, of which these have finished.
std::vector<RobotProgress> robots(const std::set<RobotId>& done) {
  std::vector<RobotProgress> rows(3);
  for (RobotId robot = 0; robot < 3; ++robot) {
    rows[robot].robot = robot;
    rows[robot].is_done = done.contains(robot);
  }
  return rows;
}

}  // namespace

TEST_CASE("a run whose robots await orders goes on as long as the agent of one of them lives") {
  CHECK_FALSE(are_fatal({}, 1, robots({0, 1, 2}), true));
  CHECK_FALSE(are_fatal({"agent 1"}, 1, robots({0, 1, 2}), true));
  CHECK_FALSE(are_fatal({"agent 1"}, 1, robots({0, 2}), true));
  CHECK_FALSE(are_fatal({"agent 0", "agent 1"}, 1, robots({0, 1, 2}), true));
  CHECK(are_fatal({"agent 0", "agent 1", "agent 2"}, 1, robots({0, 1, 2}), true));
}

TEST_CASE("a run to goals of the scenario ends when all robots have finished except those of dead agents") {
  CHECK(are_fatal({"agent 1"}, 1, robots({0, 2}), false));
  CHECK_FALSE(are_fatal({"agent 1"}, 1, robots({0}), false));
  CHECK_FALSE(are_fatal({}, 1, robots({}), false));
}

TEST_CASE("no run goes on without robots, vision and a coordinator") {
  const bool awaits_orders = GENERATE(false, true);
  for (const char* process : {"simulator", "robots", "vision"})
    CHECK(are_fatal({process}, 2, robots({}), awaits_orders));
  CHECK_FALSE(are_fatal({"coordinator"}, 2, robots({}), awaits_orders));
  CHECK_FALSE(are_fatal({"coordinator 1"}, 2, robots({}), awaits_orders));
  CHECK(are_fatal({"coordinator", "coordinator 1"}, 2, robots({}), awaits_orders));
}

}  // namespace sidestep::fatal_deaths_test
