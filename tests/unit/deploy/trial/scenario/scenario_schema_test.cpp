// SPDX-License-Identifier: Apache-2.0
// The schema for editors against the loader.
#include "deploy/trial/scenario/scenario_schema.hpp"

#include <filesystem>
#include <map>
#include <set>

#include "common/config/scenario_loader.hpp"
#include "common/random/rng.hpp"
#include "common/yaml/yaml_document.hpp"
#include "deploy/trial/scenario/key_descriptions.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"
#include "tests/unit/common/yaml/schema_check.hpp"

namespace sidestep::scenario_schema_test {

namespace fs = std::filesystem;

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/deploy/scenarios/";
const std::string kRobot = "robots: [{id: 0, start_m: [0, 0], goals_m: [[1, 0]]}]\n";

const Json& schema() {
  static const Json kSchema = Json::parse(scenario_schema());
  return kSchema;
}

std::string schema_problem_of(const std::string& text) {
  return schema_problem(schema(), json_of(parse_yaml(text, "file.yaml", "a scenario")));
}

/// Why the loader rejects a text; empty if it does not. A file with `faults` or `expect` is read as a test,
/// too.
std::string loader_problem_of(const std::string& text, const std::string& file) {
  try {
    if (parse_scenario(text, file).has_test_keys) (void)parse_fault_test(text, file);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::vector<fs::path> shipped_scenarios() {
  std::vector<fs::path> files;
  for (const char* folder : {"", "bases", "faults", "league"}) {
    for (const auto& entry : fs::directory_iterator(kScenarios + folder))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  files.emplace_back(SIDESTEP_SOURCE_DIR "/simulator/rendering/pictures/floor.yaml");
  std::ranges::sort(files);
  return files;
}

TEST_CASE("every shipped scenario fits the schema, and names it for editors in its head") {
  int count = 0;
  for (const fs::path& file : shipped_scenarios()) {
    CAPTURE(file);
    const std::string text = text_of(file);
    CHECK(schema_problem_of(text).empty());
    const fs::path named = fs::relative(kScenarios + "scenario.schema.json", file.parent_path());
    const std::string line = "# yaml-language-server: $schema=" + named.string() + "\n";
    CHECK_THAT(text.substr(0, 300), ContainsSubstring(line));
    ++count;
  }
  CHECK(count >= 35);
}

TEST_CASE("the shipped schema is the one that the loader describes") {
  // If not: build/release/bin/sidestep check --schema > deploy/scenarios/scenario.schema.json
  CHECK((text_of(kScenarios + "scenario.schema.json") == scenario_schema()));
}

TEST_CASE("wrong keys, types, ranges and lengths do not fit the schema") {
  CHECK(schema_problem_of(kRobot).empty());
  const std::string fault = kRobot + "expect: [{arrived: all}]\nfaults: [{at_s: 1, ";
  for (const std::string& wrong : std::vector<std::string>{
           "field: {}\n",
           kRobot + "margin: 0.1\n",
           kRobot + "margin_m: wide\n",
           kRobot + "margin_m: '0.1'\n",
           kRobot + "margin_m: 1.001\n",
           kRobot + "margin_m:\n",
           kRobot + "vision: {dely_ms: 3}\n",
           kRobot + "vision: {columns: 2.5}\n",
           kRobot + "vision: {images: {format: bayer}}\n",
           kRobot + "laser: {beams: 7}\n",
           kRobot + "ball: {position_m: [1]}\n",
           kRobot + "restart: [everything]\n",
           kRobot + "planner: magic\n",
           kRobot + "coordinators: 9\n",
           kRobot + "unknown: maybe\n",
           kRobot + "opponents: [{radius_m: 0.1, speed_mps: 1}]\n",
           kRobot + "opponents: [{radius_m: 0.1, speed_mps: 1, path_m: []}]\n",
           kRobot + "obstacles: [{ball: {centre_m: [0, 0]}}]\n",
           kRobot + "obstacles: [{}]\n",
           kRobot + "obstacles: [{box: {min_m: [0, 0]}}]\n",
           kRobot + "obstacles: [{wall: {points_m: [[0, 0]], thickness_m: 0.1}}]\n",
           kRobot + "obstacles: [{centre_m: [2, 2], radius_m: 0.1, hight_m: 3}]\n",
           kRobot + "circle: {count: 4}\n",
           kRobot + "streams: {count: 4, spacing_m: 1, lanes_crossed: 1001}\n",
           "robots: [{start_m: [0, 0]}]\n",
           "robots: [{id: 1024, start_m: [0, 0]}]\n",
           "robots: [{id: 0, team: red, start_m: [0, 0]}]\n",
           "robots: [{id: 0, start_m: [0, 0], goals_m: []}]\n",
           "robots: [{id: 0, start_m: [0, 0], goals_m: [[1, 0, 7]]}]\n",
           "robots: [{id: 0, start_m: [0, 0], goals_m: [1, 0]}]\n",
           "robots: [{id: 0, start_m: [0, 0], absent: 1}]\n",
           fault + "kil: agent 0}]\n",
           fault + "kill: agent x}]\n",
           fault + "kill: agent 0, restart: agent 0}]\n",
           fault + "restart: simulator}]\n",
           fault + "pause: vision}]\n",
           fault + "push: 0}]\n",
           fault + "slip: 0, grip: 2}]\n",
           fault + "network: all, delay_ms: [1, 2]}]\n",
           fault + "partition: vision, one_way: up}]\n",
           kRobot + "faults: [{kill: agent 0}]\n",
           kRobot + "expect: []\n",
           kRobot + "expect: [{no_contacts: all}]\n",
           kRobot + "expect: [{no_violations: false}]\n",
           kRobot + "expect: [{at_rest: 0}]\n",
           kRobot + "expect: [{at_rest: 0, within_s: 1, by_s: 2}]\n",
           kRobot + "expect: [{arrived: some}]\n",
           kRobot + "expect: [{named: 0, as: lost, within_s: 1}]\n",
           kRobot + "expect: [{max_speed_mps: 21}]\n",
       }) {
    CAPTURE(wrong);
    CHECK_FALSE(loader_problem_of(wrong, "file.yaml").empty());
    CHECK_FALSE(schema_problem_of(wrong).empty());
  }
}

TEST_CASE("whatever the loader accepts fits the schema, for random changes of shipped scenarios") {
  const std::uint64_t seed = 20261128;
  CAPTURE(seed);
  Rng rng(seed);
  const std::string alphabet = "[]{}:,-# \n0123456789.aeinst";
  int accepted = 0, rejected_by_both = 0;
  for (const fs::path& file : shipped_scenarios()) {
    const std::string valid = text_of(file);
    if (valid.find("map:") != std::string::npos || valid.size() > 6000) continue;  // slow to load
    for (int round = 0; round < 60; ++round) {
      std::string text = valid;
      for (auto edits = 1 + rng.below(3); edits > 0; --edits) {
        const std::size_t at = rng.below(text.size());
        if (rng.below(2) == 0)
          text[at] = alphabet[rng.below(alphabet.size())];
        else
          text.erase(at, 1 + rng.below(8));
      }
      CAPTURE(file, text);
      const std::string problem = loader_problem_of(text, file.string());
      if (problem.empty()) {
        REQUIRE(schema_problem_of(text).empty());
        ++accepted;
        continue;
      }
      try {
        rejected_by_both += schema_problem_of(text).empty() ? 0 : 1;
      } catch (const ConfigError&) {  // is no YAML
      }
    }
  }
  CHECK(accepted > 200);
  CHECK(rejected_by_both > 200);
}

/// Adds all keys of the schema with their descriptions, by path: "vision.images.format".
void collect(const Json& node, const std::string& path, std::map<std::string, std::string>& keys) {
  if (node.contains("anyOf"))
    for (const Json& alternative : node["anyOf"]) collect(alternative, path, keys);
  if (node.contains("items") && node["items"].is_object()) collect(node["items"], path, keys);
  if (!node.contains("properties")) return;
  for (const auto& property : node["properties"].items()) {
    std::string& description = keys[path + property.key()];
    description = std::max(description, property.value().value("description", ""));
    collect(property.value(), path + property.key() + ".", keys);
  }
}

TEST_CASE(
    "every key of the schema is described on the page of scenarios, and every key there is in the schema") {
  std::map<std::string, std::string> keys;
  collect(schema(), "", keys);
  const auto on_page = key_descriptions(kKeysPage);
  for (const auto& [key, description] : keys) {
    CAPTURE(key);
    const bool is_group =
        std::ranges::any_of(keys, [&](const auto& other) { return other.first.starts_with(key + "."); });
    // Obstacles are explained by an example, and secondary keys of faults beside their fault.
    const bool is_elsewhere =
        key.starts_with("obstacles.") || key.starts_with("faults.") || key.starts_with("expect.");
    if (!is_group && !is_elsewhere) CHECK_FALSE(description.empty());
  }
  for (const auto& [key, text] : on_page) {
    CAPTURE(key);
    if (!key.ends_with(".yaml")) CHECK(keys.count(key) == 1);
  }
  for (const char* fault :
       {"faults.kill", "faults.network", "faults.switch_on", "expect.arrived", "expect.named"})
    CHECK_FALSE(keys.at(fault).empty());
}

TEST_CASE("defaults and ranges of the schema are those of the page of scenarios") {
  // One figure of each kind; the test above compares the keys.
  const Json& keys = schema()["properties"];
  const auto on_page = key_descriptions(kKeysPage);
  const auto check_key = [&](const std::string& path, const Json& key) {
    CAPTURE(path);
    const std::string text = on_page.at(path);
    if (key.contains("default") && key["default"].is_number())
      CHECK_THAT(text, ContainsSubstring(fmt::format("{:.6g}", key["default"].get<double>())));
    if (key.contains("maximum"))
      CHECK_THAT(text, ContainsSubstring(fmt::format("{:.9g}", key["maximum"].get<double>())));
  };
  for (const char* key : {"radius_m", "margin_m", "tracking_bound_m", "clock_bound_s", "goal_tolerance_m",
                          "time_limit_s", "coordinators", "max_opponent_speed_mps", "command_loss"})
    check_key(key, keys[key]);
  for (const char* section : {"field", "limits", "vision", "odometry", "network", "laser"}) {
    for (const auto& key : keys[section]["properties"].items()) {
      if (key.key() != "images" && key.key() != "field_of_view_rad")
        check_key(std::string(section) + "." + key.key(), key.value());
    }
  }
}

TEST_CASE("the schema's file is found from a program in the tree in which it was built") {
  CHECK(scenario_schema_path().ends_with("/deploy/scenarios/scenario.schema.json"));
}

}  // namespace sidestep::scenario_schema_test
