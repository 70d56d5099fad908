// SPDX-License-Identifier: Apache-2.0
#include "common/config/obstacle_list.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/random/rng.hpp"
#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"

namespace sidestep::obstacle_list_test {

std::vector<Shape> obstacles(const std::string& list, std::size_t max_count = 100) {
  YamlMap map = document_map("obstacles:\n" + list, "floor.yaml", "a floor");
  return read_obstacles(map, max_count);
}

TEST_CASE("obstacles of every kind survive writing and reading") {
  const std::vector<Shape> read = obstacles(
      "  - {centre_m: [1, 2], radius_m: 0.5}\n"
      "  - circle: {centre_m: [-1, 2], radius_m: 0.25}\n"
      "  - box: {min_m: [0, 0], max_m: [1, 3]}\n"
      "  - polygon: {corners_m: [[0, 0], [1, 0], [0, 1]]}\n"
      "  - segment: {from_m: [0, 0], to_m: [1, 1]}\n");
  REQUIRE(read.size() == 5);
  std::string text;
  for (const Shape& shape : read) text += "  - " + obstacle_text(shape) + "\n";
  const std::vector<Shape> again = obstacles(text);
  REQUIRE(again.size() == read.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    CHECK(again[i].index() == read[i].index());
    CHECK(obstacle_text(again[i]) == obstacle_text(read[i]));
  }
}

TEST_CASE("a wall covers every point within half its thickness of its line, and nothing beyond its corners") {
  Rng rng(5);
  for (int i = 0; i < 300; ++i) {
    const double thickness_m = rng.uniform(0.05, 0.5);
    std::vector<Vec2> path;
    std::string points;
    for (int k = 0; k < 4; ++k) {
      const double y = rng.uniform(-3, 3),
                   x = k > 0 && rng.chance(0.3) ? path.back().x() : rng.uniform(-3, 3);
      path.emplace_back(x, y);
      points += fmt::format("{}[{}, {}]", k > 0 ? ", " : "", x, y);
    }
    const std::vector<Shape> wall =
        obstacles(fmt::format("  - wall: {{points_m: [{}], thickness_m: {}}}\n", points, thickness_m));
    REQUIRE(wall.size() == 3);
    for (int k = 0; k < 50; ++k) {
      const double y = rng.uniform(-4, 4), x = rng.uniform(-4, 4);
      double to_line_m = 100, to_wall_m = 100;
      for (std::size_t piece = 1; piece < path.size(); ++piece)
        to_line_m = std::min(to_line_m,
                             std::sqrt(squared_distance(Vec2(x, y), Segment{path[piece - 1], path[piece]})));
      for (const Shape& shape : wall) to_wall_m = std::min(to_wall_m, signed_distance({x, y}, shape));
      CAPTURE(points, x, y, to_line_m);
      if (to_line_m < thickness_m / 2 - 1e-9) CHECK(to_wall_m <= 1e-9);
      if (to_line_m > thickness_m / 2 * std::sqrt(2.0) + 1e-9) CHECK(to_wall_m > 0);
    }
  }
}

TEST_CASE("an invalid obstacle is rejected with its line and the reason") {
  const auto [list, line, why] = GENERATE(table<std::string, int, std::string>({
      {"  - {}\n", 2, "expected one of circle, box, polygon, segment, wall"},
      {"  - {circle: {centre_m: [0, 0], radius_m: 1}, box: {min_m: [0, 0], max_m: [1, 1]}}\n", 2,
       "expected one of"},
      {"  - ball: {centre_m: [0, 0]}\n", 2, "ball"},
      {"  - box: {min_m: [0, 0]}\n", 2, "max_m"},
      {"  - box: {min_m: [0, 0], max_m: [-1, 1]}\n", 2, "minimum is above its maximum"},
      {"  - circle: {centre_m: [0, .nan], radius_m: 1}\n", 2, "centre_m"},
      {"  - polygon: {corners_m: [[0, 0], [1, 0]]}\n", 2, "corners_m: expected at least 3 points"},
      {"  - polygon: {corners_m: [[0, 0], [0, 1], [1, 0]]}\n", 2, "clockwise"},
      {"  - segment: {from_m: [0, 0], to_m: [1, 1]}\n  - wall: {points_m: [[0, 0]], thickness_m: 0.1}\n", 3,
       "points_m: expected at least 2 points"},
      {"  - wall: {points_m: [[0, 0], [0, 0]], thickness_m: 0.1}\n", 2, "identical"},
      {"  - wall: {points_m: [[0, 0], [0, 1]]}\n", 2, "thickness_m"},
      {"  - wall: {points_m: [[0, 0], [0, 1]], thickness_m: 0}\n", 2, "0.001"},
  }));
  CAPTURE(list);
  try {
    (void)obstacles(list);
    FAIL("the invalid list was accepted");
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    CAPTURE(message);
    CHECK(message.find("floor.yaml:" + std::to_string(line)) == 0);
    CHECK(message.find(why) != std::string::npos);
  }
}

}  // namespace sidestep::obstacle_list_test
