// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/reachable_goals.hpp"

#include <fmt/format.h>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::reachable_goals_test {

/// Two rooms with a door of this width, and two robots, one of which passes it.
Scenario rooms(double door_m) {
  return parse_scenario(fmt::format("field: {{length_m: 6, width_m: 4}}\n"
                                    "obstacles:\n"
                                    "  - wall: {{points_m: [[0, -2], [0, {}]], thickness_m: 0.001}}\n"
                                    "  - wall: {{points_m: [[0, {}], [0, 2]], thickness_m: 0.001}}\n"
                                    "robots:\n"
                                    "  - {{id: 4, start_m: [-2, 0], goals_m: [[-1, 1], [2, 0.5]]}}\n"
                                    "  - {{id: 5, start_m: [2, -1], goals_m: [[1, 1]]}}\n",
                                    -door_m / 2 - 0.0005, door_m / 2 + 0.0005),
                        "rooms.yaml");
}

TEST_CASE("a goal behind a door that is too narrow is reported, with the width that is needed") {
  // A robot needs its diameter and the margin on both sides: 2 x (90 + 14) mm.
  CHECK(unreachable_goals(rooms(0.209)) == std::vector<std::string>{});
  const auto problems = unreachable_goals(rooms(0.207));
  REQUIRE(problems);
  CHECK(*problems ==
        std::vector<std::string>{"robot 4 cannot reach goals_m[1], (2, 0.5): no way there is 0.208 m "
                                 "wide (diameter and margins)"});
}

TEST_CASE("a robot may pass between an obstacle and the edge of the field without a margin at the edge") {
  const auto hall = [](double gap_m) {
    return parse_scenario(fmt::format("field: {{length_m: 6, width_m: 4}}\n"
                                      "obstacles:\n  - box: {{min_m: [-0.1, -2], max_m: [0.1, {}]}}\n"
                                      "robots:\n  - {{id: 0, start_m: [-2, 0], goals_m: [[2, 0]]}}\n",
                                      2 - gap_m),
                          "hall.yaml");
  };
  CHECK(unreachable_goals(hall(0.195))->empty());  // 180 + 14 mm
  CHECK(unreachable_goals(hall(0.193))->size() == 1);
}

TEST_CASE("the walls of a map are obstacles") {
  BitGrid blocked(60, 40);
  for (int row = 0; row < 40; ++row) blocked.set(30, row);
  const OccupancyMap map(MapGrid{60, 40, 0.1, {-3, -2}}, std::move(blocked));
  const Scenario scenario = parse_scenario(
      "field: {length_m: 6, width_m: 4}\nmap: x.yaml\nrobots:\n"
      "  - {id: 0, start_m: [-2, 0], goals_m: [[2, 0]]}\n",
      "hall.yaml", &map);
  CHECK(unreachable_goals(scenario)->size() == 1);
}

}  // namespace sidestep::reachable_goals_test
