// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/plan_names.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sidestep {
namespace {

constexpr std::size_t kMaxNames = 2048;

RobotId robot_from_node(const YAML::Node& node, const YamlLocation& location, const Scenario& scenario) {
  const auto robot = static_cast<RobotId>(integer_from(node, location, {0, kMaxRobots - 1}));
  if (!find_robot(scenario, robot)) location.fail(fmt::format("the scenario has no robot {}", robot));
  return robot;
}

std::string process_from_node(const YAML::Node& node, const YamlLocation& location,
                              const std::vector<std::string>& names) {
  const std::string name = text_from(node, location);
  if (std::ranges::find(names, name) == names.end())
    location.fail(fmt::format("expected one of: {}; got \"{}\"", fmt::join(names, ", "), name.substr(0, 40)));
  return name;
}

}  // namespace

std::string only_key_of(YamlMap& map, const std::vector<std::string>& keys, const char* what) {
  std::vector<std::string> found;
  for (const std::string& key : keys) {
    if (map.find(key).IsDefined()) found.push_back(key);
  }
  if (found.size() == 1) return found.front();
  if (found.empty())
    map.location().fail(fmt::format("expected {}: one of the keys {}", what, fmt::join(keys, ", ")));
  map.location().fail(fmt::format("expected {}, got {}", what, fmt::join(found, " and ")));
}

RobotId robot_from(YamlMap& map, const std::string& key, const Scenario& scenario) {
  return robot_from_node(map.require(key), map.location_of(key), scenario);
}

RobotSet robots_from(YamlMap& map, const std::string& key, const Scenario& scenario) {
  const YAML::Node node = map.require(key);
  const YamlLocation location = map.location_of(key);
  if (node.IsScalar() && node.Scalar() == "all") return {roster_of(scenario), true};
  RobotSet robots;
  if (node.IsScalar()) {
    robots.ids.push_back(robot_from_node(node, location, scenario));
    return robots;
  }
  for (const YAML::Node& element : list_from(node, location, kMaxNames))
    robots.ids.push_back(robot_from_node(element, location.of(element, location.what), scenario));
  if (robots.ids.empty()) location.fail("expected all, a robot, or a list of robots");
  return robots;
}

std::string process_from(YamlMap& map, const std::string& key, const std::vector<std::string>& names) {
  return process_from_node(map.require(key), map.location_of(key), names);
}

std::vector<std::string> processes_from(YamlMap& map, const std::string& key,
                                        const std::vector<std::string>& names) {
  const YAML::Node node = map.require(key);
  const YamlLocation location = map.location_of(key);
  if (node.IsScalar()) return {process_from_node(node, location, names)};
  std::vector<std::string> processes;
  for (const YAML::Node& element : list_from(node, location, kMaxNames))
    processes.push_back(process_from_node(element, location.of(element, location.what), names));
  if (processes.empty()) location.fail("expected a process or a list of processes");
  return processes;
}

double moment_from(YamlMap& map, const std::string& key, const Scenario& scenario) {
  return number_from(map.require(key), map.location_of(key), {0, scenario.time_limit_s});
}

}  // namespace sidestep
