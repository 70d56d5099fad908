// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_robots.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_check.hpp"

namespace sidestep {
namespace {

constexpr Range kCoordinate_m{-1000, 1000};
constexpr Range kRobotId{0, kMaxRobots - 1};
constexpr Range kClockOffset_ms{-60000, 60000};
constexpr std::size_t kMaxGoals = 10000;

struct PlacedRobot {
  RobotSpec robot;
  RobotLines lines;
};

PlacedRobot read_robot(const YAML::Node& node, const YamlLocation& location) {
  YamlMap map(node, location);
  PlacedRobot placed;
  RobotSpec& robot = placed.robot;
  placed.lines.start = location.line;
  robot.id = static_cast<RobotId>(integer_from(map.require("id"), map.location_of("id"), kRobotId));
  if (const YAML::Node team = map.find("team"); team.IsDefined()) {
    const std::string name = text_from(team, map.location_of("team"));
    if (name != "blue" && name != "yellow") map.location_of("team").fail("expected blue or yellow");
    robot.team = name == "blue" ? Team::kBlue : Team::kYellow;
  }
  map.require("start_m");
  placed.lines.start = map.location_of("start_m").line;
  map.read("start_m", kCoordinate_m, robot.start_m);
  map.read_heading("heading_rad", robot.start_heading_rad);
  map.read_ms("clock_offset_ms", kClockOffset_ms, robot.clock_offset);
  map.read("absent", robot.is_absent);
  map.read("planner", kDrivingPlanners, robot.planner);

  const YamlLocation goals = map.location_of("goals_m");
  const YAML::Node goal_list = map.find("goals_m");
  const auto elements =
      goal_list.IsDefined() ? list_from(goal_list, goals, kMaxGoals) : std::vector<YAML::Node>();
  for (const YAML::Node& element : elements) {
    const YamlLocation goal_location = goals.of(element, goals.what);
    const auto numbers = numbers_from(element, goal_location, 2, 3, kCoordinate_m);
    Goal goal{{numbers[0], numbers[1]}, std::nullopt};
    if (numbers.size() == 3) goal.heading_rad = heading_from(element[2], goal_location);
    robot.goals.push_back(goal);
    placed.lines.goals.push_back(goal_location.line);
  }
  if (goal_list.IsDefined() && robot.goals.empty()) goals.fail("expected at least one goal");
  map.finish();
  return placed;
}

/// Places robots on a circle, given the chord between neighbours. Each faces its goal, which is the opposite
/// point.
void read_circle(YamlMap& map, std::vector<PlacedRobot>& robots) {
  const YAML::Node node = map.find("circle");
  if (!node.IsDefined()) return;
  YamlMap circle(node, map.location_of("circle"));
  int count = 0, first_id = 0;
  double spacing_m = 0;
  Vec2 centre_m{0, 0};
  circle.require("count");
  circle.require("spacing_m");
  circle.read("first_id", kRobotId, first_id);
  circle.read("count", {2, static_cast<double>(kMaxRobots)}, count);
  circle.read("spacing_m", {0.01, 100}, spacing_m);
  circle.read("centre_m", kCoordinate_m, centre_m);
  circle.finish();
  const int available = static_cast<int>(kMaxRobots) - first_id;
  if (count > available) {
    circle.location_of("count").fail(fmt::format(
        "more robots than ids: expected at most {1} from id {0} on, got {2}", first_id, available, count));
  }
  const double radius_m = spacing_m / (2 * std::sin(std::numbers::pi / count));
  const int line = circle.location().line;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / count;
    const Vec2 radius = rotated(Vec2(radius_m, 0), angle_rad);
    PlacedRobot placed;
    placed.robot = {static_cast<RobotId>(first_id + i),
                    i % 2 == 0 ? Team::kBlue : Team::kYellow,
                    centre_m + radius,
                    wrapped_rad(angle_rad + std::numbers::pi),
                    {Goal{centre_m - radius, std::nullopt}}};
    placed.lines = {line, {line}};
    robots.push_back(placed);
  }
}

/// Places robots in a square grid, one per cell. In each row, pairs that drive along x alternate with pairs
/// that drive along y; every other lane runs in the opposite direction. Goals lie on cells of the same kind
/// as the starts, so no goal blocks another robot.
void read_streams(YamlMap& map, std::vector<PlacedRobot>& robots) {
  const YAML::Node node = map.find("streams");
  if (!node.IsDefined()) return;
  YamlMap streams(node, map.location_of("streams"));
  int count = 0, lanes_crossed = 0;
  double spacing_m = 0;
  for (const char* key : {"count", "spacing_m", "lanes_crossed"}) streams.require(key);
  streams.read("count", {2, static_cast<double>(kMaxRobots)}, count);
  streams.read("spacing_m", {0.01, 100}, spacing_m);
  streams.read("lanes_crossed", {4, 1000}, lanes_crossed);
  if (lanes_crossed % 4 != 0) {
    streams.location_of("lanes_crossed").fail(fmt::format("expected a multiple of 4, got {}", lanes_crossed));
  }
  streams.finish();
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  const int line = streams.location().line;
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
    const YamlLocation location = map.location_of("robots");
    if (node.IsSequence() && node.size() > kMaxRobots) {
      location.fail(
          fmt::format("more robots than ids: expected at most {}, got {}", kMaxRobots, node.size()));
    }
    for (const YAML::Node& element : list_from(node, location, kMaxRobots)) {
      robots.push_back(read_robot(element, location.of(element, fmt::format("robots[{}]", robots.size()))));
    }
  }
  read_circle(map, robots);
  read_streams(map, robots);
  if (robots.empty()) map.location().fail("no robots, expected a key \"robots\", \"circle\" or \"streams\"");
  std::stable_sort(robots.begin(), robots.end(),
                   [](const PlacedRobot& a, const PlacedRobot& b) { return a.robot.id < b.robot.id; });
  std::vector<RobotLines> lines;
  for (PlacedRobot& placed : robots) {
    scenario.robots.push_back(std::move(placed.robot));
    lines.push_back(std::move(placed.lines));
  }
  check_placement(scenario, lines, map.location().file);
}

}  // namespace sidestep
