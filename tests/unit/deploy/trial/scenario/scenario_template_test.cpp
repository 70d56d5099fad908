// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/scenario_template.hpp"

#include <cctype>
#include <sstream>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/scenario/reachable_goals.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"
#include "tests/catch.hpp"

namespace sidestep::scenario_template_test {

/// The template with all keys switched on, except a map, whose file does not exist.
std::string with_all_keys() {
  std::istringstream lines(scenario_template(""));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool is_off = line.size() > 1 && line[0] == '#' &&
                        (std::islower(static_cast<unsigned char>(line[1])) != 0 || line.starts_with("#  - "));
    text += (is_off && !line.starts_with("#map:") ? line.substr(1) : line) + "\n";
  }
  return text;
}

TEST_CASE("a new scenario is valid, and its robots can reach their goals") {
  const Scenario scenario = parse_scenario(scenario_template(""), "hall.yaml");
  CHECK(scenario.name == "hall");
  CHECK(scenario.robots.size() == 3);
  CHECK(unreachable_goals(scenario) == std::vector<std::string>{});
}

TEST_CASE("a new scenario begins with the schema for editors, if there is one") {
  CHECK(scenario_template("/x/s.json").starts_with("# yaml-language-server: $schema=/x/s.json\n# A floor"));
  CHECK(scenario_template("").starts_with("# A floor"));
}

TEST_CASE("the keys that are switched off in a new scenario are valid, too") {
  const FaultTest test = parse_fault_test(with_all_keys(), "hall.yaml");
  CHECK(test.scenario.robots.size() == 4);
  CHECK(test.scenario.robots[3].goals.empty());
  CHECK(test.scenario.obstacles.size() == 5);
  CHECK(test.scenario.opponents.size() == 1);
  CHECK(test.scenario.coordinators == 2);
  CHECK(test.scenario.restart.agents);
  CHECK(test.faults.size() == 2);
  CHECK(test.expectations.size() == 2);
}

TEST_CASE("values that a new scenario spells out are the defaults, except for its own hall") {
  const Scenario scenario = parse_scenario(scenario_template(""), "hall.yaml"), defaults;
  CHECK(scenario.radius_m == defaults.radius_m);
  CHECK(scenario.margin_m == defaults.margin_m);
  CHECK(scenario.tracking_bound_m == defaults.tracking_bound_m);
  CHECK(scenario.clock_bound_s == defaults.clock_bound_s);
  CHECK(scenario.limits.speed_mps == defaults.limits.speed_mps);
  CHECK(scenario.limits.acceleration_mps2 == defaults.limits.acceleration_mps2);
  CHECK(scenario.limits.deceleration_mps2 == defaults.limits.deceleration_mps2);
  CHECK(scenario.time_limit_s == defaults.time_limit_s);
  CHECK(scenario.vision.rate_hz == defaults.vision.rate_hz);
  CHECK(scenario.vision.delay == defaults.vision.delay);
}

}  // namespace sidestep::scenario_template_test
