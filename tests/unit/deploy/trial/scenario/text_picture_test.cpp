// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/text_picture.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::text_picture_test {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_CASE("a floor is drawn with its robots, goals and obstacles, the positive directions up and right") {
  const Scenario scenario = parse_scenario(
      "field: {length_m: 6, width_m: 4}\n"
      "obstacles: [{wall: {points_m: [[0, 0.5], [0, 2]], thickness_m: 0.1}}]\n"
      "opponents: [{radius_m: 0.1, speed_mps: 1, path_m: [[-2.5, -1.5], [2.5, -1.5]]}]\n"
      "robots:\n"
      "  - {id: 0, start_m: [-2, 1], goals_m: [[-1, 0], [2, 1]]}\n"
      "  - {id: 12, start_m: [2, 0]}\n",
      "hall.yaml");
  CHECK(text_picture(scenario, 32) ==
        "+------------------------------+\n"
        "|              ##              |\n"
        "|              ##              |\n"
        "|     0        ##        (0)   |\n"
        "|              ##              |\n"
        "|                              |\n"
        "|          +             12    |\n"
        "|                              |\n"
        "|                              |\n"
        "|  !.........................  |\n"
        "|                              |\n"
        "+------------------------------+\n"
        "0 start of robot 0   (0) its last goal\n"
        "+ a goal before the last\n"
        "# an obstacle\n"
        "! a moving obstacle at its start\n"
        ". the path of a moving obstacle\n"
        "x is -3 to 3 m, y is -2 to 2 m; a character is 0.2 m wide and 0.4 m high\n");
}

TEST_CASE("a picture is no wider than the terminal, and obstacles thinner than a character are seen") {
  for (const int columns : {20, 40, 60, 80, 120}) {
    CAPTURE(columns);
    const Scenario scenario = parse_scenario(
        "field: {length_m: 40, width_m: 12}\n"
        "obstacles: [{segment: {from_m: [1, -5], to_m: [1, 5]}}]\n"
        "robots: [{id: 0, start_m: [-2, 1]}]\n",
        "hall.yaml");
    const auto lines = lines_of(text_picture(scenario, columns));
    const auto frame =
        std::ranges::count_if(lines, [](const std::string& line) { return line.starts_with('|'); });
    CHECK(frame >= 3);
    CHECK(std::ranges::count_if(lines, [](const std::string& line) {
            return line.starts_with('|') && line.find('#') != std::string::npos;
          }) >= frame / 2);
    for (const std::string& line : lines)
      if (line.starts_with('|') || line.starts_with("+-"))
        CHECK(line.size() <= static_cast<std::size_t>(columns));
  }
}

TEST_CASE("a tall floor is no higher than a screen") {
  const Scenario scenario = parse_scenario(
      "field: {length_m: 2, width_m: 100}\nrobots: [{id: 0, start_m: [0, 1]}]\n", "shaft.yaml");
  const auto lines = lines_of(text_picture(scenario, 80));
  CHECK(std::ranges::count_if(lines, [](const std::string& line) { return line.starts_with('|'); }) <= 40);
}

TEST_CASE("robots whose names would overlap are drawn as one character each") {
  const Scenario scenario = parse_scenario(
      "field: {length_m: 8, width_m: 8}\ncircle: {count: 100, spacing_m: 0.2}\n", "circle.yaml");
  const std::string picture = text_picture(scenario, 60);
  CHECK_THAT(picture, ContainsSubstring("o of another"));
  CHECK_THAT(picture, ContainsSubstring("x of another"));
}

}  // namespace sidestep::text_picture_test
