// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/goal_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <system_error>

#include "common/messaging/version_codec.hpp"
#include "common/process/command_line.hpp"
#include "common/yaml/heading.hpp"
#include "common/yaml/plus_sign.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {
namespace {

constexpr Range kCoordinate{-kMaxCoordinate_m, kMaxCoordinate_m};

/// Reads a comma-separated list of up to three numbers. Returns an empty list if the text is anything else.
std::vector<double> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  const char *at = text.data(), *const end = at + text.size();
  while (numbers.size() < 3) {
    double number = 0;
    const auto [stop, error] = std::from_chars(without_plus({at, end}).data(), end, number);
    if (error != std::errc{} || !std::isfinite(number)) return {};
    numbers.push_back(number);
    if (stop == end) return numbers;
    if (*stop != ',') return {};
    at = stop + 1;
  }
  return {};
}

Goal goal_from(const std::vector<double>& numbers) {
  Goal goal{{numbers[0], numbers[1]}};
  if (numbers.size() == 3) goal.heading_rad = numbers[2];
  return goal;
}

Goal goal_from(const YAML::Node& node, const YamlLocation& location) {
  Goal goal = goal_from(numbers_from(node, location, 2, 3, kCoordinate));
  if (goal.heading_rad) goal.heading_rad = heading_from(node[2], location);
  return goal;
}

/// Throws UsageError if a coordinate is too large.
void require_near(const std::string& text, const std::vector<double>& numbers) {
  if (std::max(std::abs(numbers[0]), std::abs(numbers[1])) > kMaxCoordinate_m)
    throw UsageError(fmt::format("\"{}\": expected coordinates from {:g} to {:g} m", text, -kMaxCoordinate_m,
                                 kMaxCoordinate_m));
}

}  // namespace

Goal parse_goal(const std::string& text) {
  const auto numbers = parse_numbers(text);
  if (numbers.size() < 2 || numbers.size() > 3)
    throw UsageError(
        fmt::format("\"{}\" is not a goal, expected X,Y or X,Y,HEADING in metres and radians", text));
  require_near(text, numbers);
  if (numbers.size() == 3) {
    if (const std::string problem = heading_problem(numbers[2]); !problem.empty())
      throw UsageError(fmt::format("\"{}\": {}", text, problem));
  }
  return goal_from(numbers);
}

Vec2 parse_place(const std::string& text, const std::string& what) {
  const auto numbers = parse_numbers(text);
  if (numbers.size() != 2)
    throw UsageError(fmt::format("\"{}\" is not a {}, expected X,Y in metres", text, what));
  require_near(text, numbers);
  return {numbers[0], numbers[1]};
}

RobotId parse_robots(const std::string& text) {
  if (text == "all") return kAllRobots;
  RobotId robot = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, robot);
  if (error != std::errc{} || stop != end || robot >= kMaxRobots)
    throw UsageError(fmt::format("\"{}\" is not a robot, expected 0 to {} or all", text, kMaxRobots - 1));
  return robot;
}

GoalLists parse_goal_lists(const std::string& text, const std::string& file_name) {
  const YAML::Node root = parse_yaml(text, file_name, "goals of robots");
  const YamlLocation location = YamlLocation{file_name, 1, "goals"}.of(root, "goals");
  if (!root.IsMap()) location.fail("expected robots with their goals, such as \"3: [[1.2, -0.4]]\"");
  GoalLists lists;
  for (const auto& entry : root) {
    const auto robot = static_cast<RobotId>(
        integer_from(entry.first, location.of(entry.first, "robot"), {0, kMaxRobots - 1}));
    const YamlLocation of_robot = location.of(entry.first, fmt::format("robot {}", robot));
    if (lists.contains(robot)) of_robot.fail("given twice");
    std::vector<Goal>& goals = lists[robot];
    refuse_single_point(entry.second, of_robot);
    for (const YAML::Node& element : list_from(entry.second, of_robot, msg::MAX_ORDER_POSES))
      goals.push_back(goal_from(element, of_robot.of(element, of_robot.what)));
    if (goals.empty()) of_robot.fail("expected at least one goal");
  }
  if (lists.empty()) location.fail("expected at least one robot");
  return lists;
}

}  // namespace sidestep
