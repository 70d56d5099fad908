// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/robot_list.hpp"

#include "tests/catch.hpp"

namespace sidestep::robot_list_test {

TEST_CASE("robots are selected by numbers and ranges, and invalid selections are reported") {
  Scenario scenario;
  scenario.name = "twelve";
  for (RobotId id = 0; id < 12; ++id) {
    RobotSpec robot;
    robot.id = id;
    scenario.robots.push_back(robot);
  }
  CHECK(select_robots(scenario, "all").size() == 12);
  CHECK(select_robots(scenario, "3") == std::vector<RobotId>{3});
  CHECK(select_robots(scenario, "9-11,0,2-2,0") == std::vector<RobotId>{0, 2, 9, 10, 11});
  for (const char* wrong : {"", "a", "3-", "-3", "5-3", "1,,2", "1;2", "99999999999999"}) {
    CAPTURE(wrong);
    CHECK_THROWS_WITH(select_robots(scenario, wrong), StartsWith("--robots: expected numbers and ranges"));
  }
  CHECK_THROWS_WITH(select_robots(scenario, "10-12"), "--robots: scenario twelve has no robot 12");
}

}  // namespace sidestep::robot_list_test
