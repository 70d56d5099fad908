// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/scenario_picture.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::scenario_picture_test {

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_CASE(
    "the picture of a scenario shows starts with directions, goals, obstacles, moving obstacles, scale and "
    "legend") {
  const Scenario scenario = parse_scenario(
      "field: {length_m: 6, width_m: 4}\n"
      "obstacles: [{box: {min_m: [0, 0.5], max_m: [0.1, 2]}}]\n"
      "opponents: [{radius_m: 0.1, speed_mps: 1, path_m: [[-2.5, -1.5], [2.5, -1.5]]}]\n"
      "robots:\n"
      "  - {id: 23, start_m: [-2, 1], heading_rad: 1.5708, goals_m: [[-1, 0], [2, 1]]}\n"
      "  - {id: 12, start_m: [2, 0]}\n",
      "hall.yaml");
  const std::string svg = scenario_picture(scenario);
  CHECK(svg.starts_with("<svg "));
  CHECK(svg.ends_with("</svg>\n"));
  CHECK(count_of(svg, ">23</text>") == 2);  // start and last goal
  CHECK(count_of(svg, ">12</text>") == 1);  // has no goal
  CHECK(count_of(svg, "<polygon") == 1);
  CHECK(count_of(svg, "#cf222e") == 3);  // the opponent, its path and its symbol in the legend
  CHECK_THAT(svg, ContainsSubstring(">0.5 m</text>"));
  for (const char* entry :
       {"start and direction", "last goal", "earlier goal", "obstacle", "moving obstacle"})
    CHECK_THAT(svg, ContainsSubstring(std::string(">") + entry + "</text>"));
  // 188.3 pixels per metre: the direction of robot 23 points up.
  CHECK_THAT(svg, ContainsSubstring("<polyline points='236.3,248.3 236.3,219.5 '"));
}

TEST_CASE("robots in a wide hall are drawn large enough to read their numbers") {
  const Scenario scenario = parse_scenario(
      "field: {length_m: 100, width_m: 40}\nrobots: [{id: 3, start_m: [-2, 1]}]\n", "hall.yaml");
  CHECK_THAT(scenario_picture(scenario), ContainsSubstring("r='9.0'"));
}

}  // namespace sidestep::scenario_picture_test
