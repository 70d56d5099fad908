// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/goal_text.hpp"

#include "common/process/command_line.hpp"
#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"

namespace sidestep::goal_text_test {

TEST_CASE("a goal is parsed from a place with or without a heading") {
  CHECK(parse_goal("1.2,-0.4").position_m == Vec2(1.2, -0.4));
  CHECK_FALSE(parse_goal("1.2,-0.4").heading_rad);
  CHECK(parse_goal("-1,2,1.5").heading_rad == 1.5);
  CHECK(parse_goal("-.5,+1.0").position_m == Vec2(-0.5, 1));
  CHECK(parse_goal("+.5,1e-1,-6.28").position_m == Vec2(0.5, 0.1));
  CHECK_THROWS_WITH(parse_goal("1,2,90"), ContainsSubstring("90 degrees are 1.571 radians"));
  CHECK_THROWS_WITH(parse_goal("1e9,0"), ContainsSubstring("expected coordinates from -"));
  for (const char* text : {"", "1", "1,", "1,2,", "1,2,3,4", "1,2,3,", "a,b", "1;2", "nan,1", "1,inf",
                           "1e9,0", "1,2 ", ",1,2", "+-1,2", "++1,2", "+,1", "1,2,-7"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_goal(text), UsageError);
  }
}

TEST_CASE("an order addresses one robot or all robots") {
  CHECK(parse_robots("7") == 7);
  CHECK(parse_robots("all") == kAllRobots);
  for (const char* text : {"", "-1", "1024", "3x", "ALL", "4294967295"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_robots(text), UsageError);
  }
}

TEST_CASE("a file gives goals to several robots, and an error in it is reported with its line") {
  const GoalLists lists = parse_goal_lists("3: [[1.2, -0.4], [0, 0, 1.5]]\n12: [[1, 1]]\n", "goals.yaml");
  REQUIRE(lists.size() == 2);
  REQUIRE(lists.at(3).size() == 2);
  CHECK(lists.at(3)[0].position_m == Vec2(1.2, -0.4));
  CHECK(lists.at(3)[1].heading_rad == 1.5);
  const auto error_of = [](const std::string& text) -> std::string {
    try {
      (void)parse_goal_lists(text, "goals.yaml");
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::pair<const char*, const char*> cases[] = {
      {"", "goals.yaml"},
      {"- 1\n", "expected robots with their goals"},
      {"3: []\n", "goals.yaml:1: robot 3: expected at least one goal"},
      {"3: [1, 2]\n", "goals.yaml:1: robot 3: expected a list of points, e.g. [[3, 1]], got \"1\""},
      {"3: [[1, 2]]\n4: [[1]]\n", "goals.yaml:2: "},
      {"3: [[1, 2]]\n3: [[1, 2]]\n", "goals.yaml:2: "},
      {"x: [[1, 2]]\n", "goals.yaml:1: "},
      {"1024: [[1, 2]]\n", "goals.yaml:1: "},
      {"3: [[1, .nan]]\n", "goals.yaml:1: "},
      {"3:\n  - [1, 2, 90]\n",
       "goals.yaml:2: robot 3: expected a heading of -6.28 to 6.28 radians, got 90; 90 degrees are 1.571 "
       "radians"},
  };
  for (const auto& [text, expected] : cases) {
    INFO(text);
    CHECK_THAT(error_of(text), ContainsSubstring(expected));
  }
}

}  // namespace sidestep::goal_text_test
