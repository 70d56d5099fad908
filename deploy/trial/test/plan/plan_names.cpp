// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/plan_names.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common/file/similar_name.hpp"
#include "common/yaml/yaml_schema.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxNames = 2048;
constexpr Range kRobot{0, kMaxRobots - 1};

RobotId robot_from_node(const YAML::Node& node, const YamlLocation& location, const Scenario& scenario) {
  const auto robot = static_cast<RobotId>(integer_from(node, location, kRobot));
  if (!find_robot(scenario, robot)) location.fail(fmt::format("the scenario has no robot {}", robot));
  return robot;
}

std::string process_from_node(const YAML::Node& node, const YamlLocation& location,
                              const std::vector<std::string>& names) {
  const std::string name = text_from(node, location);
  if (std::ranges::find(names, name) == names.end())
    location.fail(fmt::format("expected one of: {}; got \"{}\"{}", fmt::join(names, ", "), name.substr(0, 40),
                              did_you_mean(name, names)));
  return name;
}

/// Throws ConfigError for a mapping that has none of the keys, and names those that it has.
[[noreturn]] void fail_without_key(YamlMap& map, const std::vector<std::string>& keys, const char* what) {
  const std::vector<std::string> given = map.keys();
  std::string hint;
  for (const std::string& key : given) {
    if (hint.empty()) hint = did_you_mean(key.substr(0, 40), keys);
  }
  map.location().fail(fmt::format("expected {}: one of the keys {}{}{}{}", what, fmt::join(keys, ", "),
                                  given.empty() ? "" : "; got ",
                                  fmt::format("{}", fmt::join(given, ", ")).substr(0, 80), hint));
}

/// A valid value for a map that is made from a schema and has no content; empty if there is no name.
std::string first_of(const std::vector<std::string>& names) {
  return names.empty() ? std::string() : names.front();
}

}  // namespace

std::string only_key_of(YamlMap& map, const std::vector<std::string>& keys, const char* what) {
  if (YamlSchema* const schema = map.schema()) return schema->choose(keys);
  std::vector<std::string> found;
  for (const std::string& key : keys) {
    if (map.find(key).IsDefined()) found.push_back(key);
  }
  if (found.size() == 1) return found.front();
  if (found.empty()) fail_without_key(map, keys, what);
  map.location().fail(fmt::format("expected {}, got {}", what, fmt::join(found, " and ")));
}

RobotId robot_from(YamlMap& map, const std::string& key, const Scenario& scenario) {
  const YAML::Node node = map.require(key);
  if (YamlSchema* const schema = map.schema()) {
    schema->add(key, integer_schema(kRobot));
    return 0;
  }
  return robot_from_node(node, map.location_of(key), scenario);
}

std::optional<RobotSet> find_robots(YamlMap& map, const std::string& key, const Scenario& scenario) {
  if (YamlSchema* const schema = map.schema()) {
    const JsonSchema robot = integer_schema(kRobot);
    schema->add(key, any_schema_of({{{"const", "all"}}, robot, list_schema(robot, 1, kMaxNames)}));
    return std::nullopt;
  }
  const YAML::Node node = map.find(key);
  if (!node.IsDefined()) return std::nullopt;
  const YamlLocation location = map.location_of(key);
  if (node.IsScalar() && node.Scalar() == "all") return RobotSet{roster_of(scenario), true};
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

RobotSet robots_from(YamlMap& map, const std::string& key, const Scenario& scenario) {
  (void)map.require(key);
  return find_robots(map, key, scenario).value_or(RobotSet{});
}

std::optional<std::string> find_process(YamlMap& map, const std::string& key,
                                        const std::vector<std::string>& names) {
  const YAML::Node node = map.find(key);
  if (YamlSchema* const schema = map.schema()) schema->add(key, name_schema(names));
  if (!node.IsDefined()) return std::nullopt;
  return process_from_node(node, map.location_of(key), names);
}

std::string process_from(YamlMap& map, const std::string& key, const std::vector<std::string>& names) {
  (void)map.require(key);
  return find_process(map, key, names).value_or(first_of(names));
}

std::optional<std::vector<std::string>> find_processes(YamlMap& map, const std::string& key,
                                                       const std::vector<std::string>& names) {
  const YAML::Node node = map.find(key);
  if (YamlSchema* const schema = map.schema()) {
    const JsonSchema process = name_schema(names);
    schema->add(key, any_schema_of({process, list_schema(process, 1, kMaxNames)}));
  }
  if (!node.IsDefined()) return std::nullopt;
  const YamlLocation location = map.location_of(key);
  if (node.IsScalar()) return std::vector{process_from_node(node, location, names)};
  std::vector<std::string> processes;
  for (const YAML::Node& element : list_from(node, location, kMaxNames))
    processes.push_back(process_from_node(element, location.of(element, location.what), names));
  if (processes.empty()) location.fail("expected a process or a list of processes");
  return processes;
}

std::vector<std::string> processes_from(YamlMap& map, const std::string& key,
                                        const std::vector<std::string>& names) {
  (void)map.require(key);
  return find_processes(map, key, names).value_or(std::vector{first_of(names)});
}

double moment_from(YamlMap& map, const std::string& key, const Scenario& scenario) {
  (void)map.require(key);
  return map.number(key, {0, scenario.time_limit_s}).value_or(0);
}

}  // namespace sidestep
