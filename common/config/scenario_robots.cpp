// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_robots.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "common/config/scenario_check.hpp"

namespace sidestep {
namespace {

constexpr Range kPlace_m{-1000, 1000};
constexpr Range kAngle_rad{-2 * std::numbers::pi, 2 * std::numbers::pi};
constexpr Range kRobotId{0, kMaxRobots - 1};
constexpr Range kClockOffset_ms{-60000, 60000};
constexpr std::size_t kMaxGoals = 1000;

struct PlacedRobot {
  RobotSpec robot;
  RobotLines lines;
};

PlacedRobot read_robot(const YAML::Node& node, const YamlPlace& place) {
  YamlMap map(node, place);
  PlacedRobot placed;
  RobotSpec& robot = placed.robot;
  placed.lines.start = place.line;
  robot.id = static_cast<RobotId>(integer_from(map.require("id"), map.place_of("id"), kRobotId));
  if (const YAML::Node team = map.find("team"); team.IsDefined()) {
    const std::string name = text_from(team, map.place_of("team"));
    if (name != "blue" && name != "yellow") map.place_of("team").refuse("expected blue or yellow");
    robot.team = name == "blue" ? Team::kBlue : Team::kYellow;
  }
  map.require("start_m");
  placed.lines.start = map.place_of("start_m").line;
  map.read("start_m", kPlace_m, robot.start_m);
  map.read("heading_rad", kAngle_rad, robot.start_heading_rad);
  map.read_ms("clock_offset_ms", kClockOffset_ms, robot.clock_offset);
  map.read("absent", robot.is_absent);

  const YamlPlace goals = map.place_of("goals_m");
  for (const YAML::Node& element : list_from(map.require("goals_m"), goals, kMaxGoals)) {
    const YamlPlace here = goals.of(element, goals.what);
    const auto numbers = numbers_from(element, here, 2, 3, kPlace_m);
    Goal goal{{numbers[0], numbers[1]}, std::nullopt};
    if (numbers.size() == 3) goal.heading_rad = number_from(element[2], here, kAngle_rad);
    robot.goals.push_back(goal);
    placed.lines.goals.push_back(here.line);
  }
  if (robot.goals.empty()) goals.refuse("expected at least one goal");
  map.finish();
  return placed;
}

/// Robots along a circle with the chord between neighbours given, each looking at its goal, the opposite
/// point.
void read_circle(YamlMap& map, std::vector<PlacedRobot>& robots) {
  const YAML::Node node = map.find("circle");
  if (!node.IsDefined()) return;
  YamlMap circle(node, map.place_of("circle"));
  int count = 0, first_id = 0;
  double spacing_m = 0;
  Vec2 centre_m{0, 0};
  circle.require("count");
  circle.require("spacing_m");
  circle.read("first_id", kRobotId, first_id);
  circle.read("count", {2, static_cast<double>(kMaxRobots)}, count);
  circle.read("spacing_m", {0.01, 100}, spacing_m);
  circle.read("centre_m", kPlace_m, centre_m);
  circle.finish();
  const int left = static_cast<int>(kMaxRobots) - first_id;
  if (count > left) {
    circle.place_of("count").refuse(fmt::format(
        "more robots than ids: from id {} on expected at most {}, got {}", first_id, left, count));
  }
  const double radius_m = spacing_m / (2 * std::sin(std::numbers::pi / count));
  const int line = circle.place().line;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / count;
    const Vec2 arm = rotated(Vec2(radius_m, 0), angle_rad);
    PlacedRobot placed;
    placed.robot = {static_cast<RobotId>(first_id + i),
                    i % 2 == 0 ? Team::kBlue : Team::kYellow,
                    centre_m + arm,
                    wrapped_rad(angle_rad + std::numbers::pi),
                    {Goal{centre_m - arm, std::nullopt}}};
    placed.lines = {line, {line}};
    robots.push_back(placed);
  }
}

/// Robots all over a square, one on each field of a board, two by two along x and along y, every other lane
/// the other way. Goals lie on fields of the same kind, so none is in another's way.
void read_streams(YamlMap& map, std::vector<PlacedRobot>& robots) {
  const YAML::Node node = map.find("streams");
  if (!node.IsDefined()) return;
  YamlMap streams(node, map.place_of("streams"));
  int count = 0, lanes_crossed = 0;
  double spacing_m = 0;
  for (const char* key : {"count", "spacing_m", "lanes_crossed"}) streams.require(key);
  streams.read("count", {2, static_cast<double>(kMaxRobots)}, count);
  streams.read("spacing_m", {0.01, 100}, spacing_m);
  streams.read("lanes_crossed", {4, 1000}, lanes_crossed);
  if (lanes_crossed % 4 != 0) {
    streams.place_of("lanes_crossed").refuse(fmt::format("expected a multiple of 4, got {}", lanes_crossed));
  }
  streams.finish();
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  const int line = streams.place().line;
  for (int i = 0; i < count; ++i) {
    const int column = i % side, row = i / side;
    const bool along_x = (column + 2 * row) % 4 < 2;
    const double sign = (along_x ? row : column) % 2 == 0 ? 1 : -1;
    const Vec2 direction = sign * (along_x ? Vec2(1, 0) : Vec2(0, 1));
    const Vec2 start = spacing_m * Vec2(column - 0.5 * (side - 1), row - 0.5 * (side - 1));
    PlacedRobot placed;
    placed.robot = {static_cast<RobotId>(i),
                    along_x ? Team::kBlue : Team::kYellow,
                    start,
                    std::atan2(direction.y(), direction.x()),
                    {Goal{start + spacing_m * lanes_crossed * direction, std::nullopt}}};
    placed.lines = {line, {line}};
    robots.push_back(placed);
  }
}

}  // namespace

void read_robots(YamlMap& map, Scenario& scenario) {
  std::vector<PlacedRobot> robots;
  if (const YAML::Node node = map.find("robots"); node.IsDefined()) {
    const YamlPlace place = map.place_of("robots");
    if (node.IsSequence() && node.size() > kMaxRobots) {
      place.refuse(fmt::format("more robots than ids: expected at most {}, got {}", kMaxRobots, node.size()));
    }
    for (const YAML::Node& element : list_from(node, place, kMaxRobots)) {
      robots.push_back(read_robot(element, place.of(element, fmt::format("robots[{}]", robots.size()))));
    }
  }
  read_circle(map, robots);
  read_streams(map, robots);
  if (robots.empty())
    map.place().refuse("no robots, expected a key \"robots\", \"circle\" or \"streams\" that gives some");
  std::stable_sort(robots.begin(), robots.end(),
                   [](const PlacedRobot& a, const PlacedRobot& b) { return a.robot.id < b.robot.id; });
  std::vector<RobotLines> lines;
  for (PlacedRobot& placed : robots) {
    scenario.robots.push_back(std::move(placed.robot));
    lines.push_back(std::move(placed.lines));
  }
  check_placement(scenario, lines, map.place().file);
}

}  // namespace sidestep
