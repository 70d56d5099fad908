// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_robots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_check.hpp"
#include "common/yaml/yaml_schema.hpp"

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

constexpr std::array<std::string_view, 2> kTeams{"blue", "yellow"};

void read_goals(YamlMap& map, PlacedRobot& placed) {
  const YamlLocation location = map.location_of("goals_m");
  const YAML::Node list = map.find("goals_m");
  if (YamlSchema* const schema = map.schema()) {
    const JsonSchema coordinate = number_schema(kCoordinate_m);
    schema->add("goals_m",
                list_schema(tuple_schema({coordinate, coordinate, heading_schema()}, 2), 1, kMaxGoals));
  }
  if (!list.IsDefined()) return;
  refuse_single_point(list, location);
  for (const YAML::Node& element : list_from(list, location, kMaxGoals)) {
    const YamlLocation goal_location = location.of(element, location.what);
    const auto numbers = numbers_from(element, goal_location, 2, 3, kCoordinate_m);
    Goal goal{{numbers[0], numbers[1]}, std::nullopt};
    if (numbers.size() == 3) goal.heading_rad = heading_from(element[2], goal_location);
    placed.robot.goals.push_back(goal);
    placed.lines.goals.push_back(goal_location.line);
  }
  if (placed.robot.goals.empty()) location.fail("expected at least one goal");
}

PlacedRobot read_robot(YamlMap& map) {
  PlacedRobot placed;
  RobotSpec& robot = placed.robot;
  (void)map.require("id");
  robot.id = static_cast<RobotId>(map.integer("id", kRobotId).value_or(0));
  std::string team{kTeams.front()};
  map.read("team", kTeams, team);
  robot.team = team == "blue" ? Team::kBlue : Team::kYellow;
  (void)map.require("start_m");
  placed.lines.start = map.location_of("start_m").line;
  map.read("start_m", kCoordinate_m, robot.start_m);
  map.read_heading("heading_rad", robot.start_heading_rad);
  map.read_ms("clock_offset_ms", kClockOffset_ms, robot.clock_offset);
  map.read("absent", robot.is_absent);
  map.read("planner", kDrivingPlanners, robot.planner);
  read_goals(map, placed);
  map.finish();
  return placed;
}

/// A group of robots around a centre, each of which drives to the point opposite its start.
struct OppositeGroup {
  int first_id = 0, count = 0;
  double spacing_m = 0;
  Vec2 centre_m{0, 0};
  int line = 0;
};

OppositeGroup read_opposite_group(YamlMap& map) {
  OppositeGroup group;
  for (const char* key : {"count", "spacing_m"}) (void)map.require(key);
  map.read("first_id", kRobotId, group.first_id);
  map.read("count", {2, static_cast<double>(kMaxRobots)}, group.count);
  map.read("spacing_m", {0.01, 100}, group.spacing_m);
  map.read("centre_m", kCoordinate_m, group.centre_m);
  map.finish();
  group.line = map.location().line;
  const int available = static_cast<int>(kMaxRobots) - group.first_id;
  if (group.count > available) {
    map.location_of("count").fail(
        fmt::format("more robots than ids: expected at most {1} from id {0} on, got {2}", group.first_id,
                    available, group.count));
  }
  return group;
}

/// Adds a robot that faces its goal, the point opposite its start.
void add_to_group(const OppositeGroup& group, int number, const Vec2& from_centre_m,
                  std::vector<PlacedRobot>& robots) {
  PlacedRobot placed;
  placed.robot = {static_cast<RobotId>(group.first_id + number),
                  number % 2 == 0 ? Team::kBlue : Team::kYellow,
                  group.centre_m + from_centre_m,
                  std::atan2(-from_centre_m.y(), -from_centre_m.x()),
                  {Goal{group.centre_m - from_centre_m, std::nullopt}}};
  placed.lines = {group.line, {group.line}};
  robots.push_back(placed);
}

/// Places robots on a circle, given the chord between neighbours.
void read_circle(YamlMap& circle, std::vector<PlacedRobot>& robots) {
  const OppositeGroup group = read_opposite_group(circle);
  const double radius_m = group.spacing_m / (2 * std::sin(std::numbers::pi / group.count));
  for (int i = 0; i < group.count; ++i)
    add_to_group(group, i, rotated(Vec2(radius_m, 0), 2 * std::numbers::pi * i / group.count), robots);
}

/// Places robots on those points of a triangular lattice that are nearest to the middle of one of its
/// triangles, so that no robot starts at its goal.
void read_disc(YamlMap& disc, std::vector<PlacedRobot>& robots) {
  const OppositeGroup group = read_opposite_group(disc);
  const int reach = static_cast<int>(std::ceil(std::sqrt(group.count))) + 2;
  const Vec2 middle(0.5, 0.5 / std::numbers::sqrt3);
  std::vector<Vec2> points;  // in units of the spacing
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column)
      points.push_back(Vec2(column + 0.5 * (row % 2), std::sqrt(0.75) * row) - middle);
  // Rounding must not decide between points that are equally far away.
  std::ranges::stable_sort(points, {},
                           [](const Vec2& point) { return std::llround(1e6 * point.squaredNorm()); });
  for (int i = 0; i < group.count; ++i)
    add_to_group(group, i, group.spacing_m * points[static_cast<std::size_t>(i)], robots);
}

/// Places robots in a square grid, one per cell. In each row, pairs that drive along x alternate with pairs
/// that drive along y; every other lane runs in the opposite direction. Goals lie on cells of the same kind
/// as the starts, so no goal blocks another robot.
void read_streams(YamlMap& streams, std::vector<PlacedRobot>& robots) {
  int count = 0, lanes_crossed = 0;
  double spacing_m = 0;
  for (const char* key : {"count", "spacing_m", "lanes_crossed"}) (void)streams.require(key);
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
  if (const YAML::Node node = map.find("robots"); node.IsSequence() && node.size() > kMaxRobots) {
    map.location_of("robots").fail(
        fmt::format("more robots than ids: expected at most {}, got {}", kMaxRobots, node.size()));
  }
  read_optional_list(map, "robots", 0, kMaxRobots,
                     [&](YamlMap& robot) { robots.push_back(read_robot(robot)); });
  read_section(map, "circle", [&](YamlMap& circle) { read_circle(circle, robots); });
  read_section(map, "disc", [&](YamlMap& disc) { read_disc(disc, robots); });
  read_section(map, "streams", [&](YamlMap& streams) { read_streams(streams, robots); });
  if (YamlSchema* const schema = map.schema())
    return schema->require_any(std::array<std::string, 4>{"robots", "circle", "disc", "streams"});
  if (robots.empty())
    map.location().fail("no robots, expected a key \"robots\", \"circle\", \"disc\" or \"streams\"");
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
