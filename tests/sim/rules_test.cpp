// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"
#include "common/protocol/process_names.hpp"
#include "deploy/trial/simulate/campaign/rule_mutations.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::rules_test {

using namespace std::chrono_literals;

Scenario crossing() {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/crossing.yaml");
}

Scenario without_robot(Scenario scenario, RobotId robot) {
  std::erase_if(scenario.robots, [=](const RobotSpec& spec) { return spec.id == robot; });
  return scenario;
}

/// Restarts a process with another scenario.
void replace(SimSystem& system, const std::string& process, const Scenario& scenario) {
  system.kill(process);
  system.use_scenario(process, scenario);
  system.restart(process);
}

/// The keys of the rules in which a process differs, according to the report.
std::vector<std::string> differing_keys(const Report& report, const std::string& process) {
  std::vector<std::string> keys;
  const auto found = report.mismatches.find(process);
  if (found == report.mismatches.end()) return keys;
  for (const RuleDifference& rule : found->second) keys.push_back(rule.key);
  return keys;
}

double max_speed_mps(const SimSystem& system) {
  double result = 0;
  for (const RobotProgress& row : system.metrics().progress()) result = std::max(result, row.speed_mps);
  return result;
}

TEST_CASE("a coordinator whose scenario lacks a robot is refused and reported, and no robot moves") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = crossing();
    SimSystem system(scenario, seed);
    replace(system, "coordinator", without_robot(scenario, 7));
    system.run_for(1s);
    CHECK(differing_keys(system.metrics().report(), "coordinator") ==
          std::vector<std::string>{"robots.yellow"});
    for (int i = 0; i < 50; ++i) {
      system.run_for(100ms);
      REQUIRE(max_speed_mps(system) < 0.02);
    }
    CHECK(system.metrics().report().contacts == 0);
    replace(system, "coordinator", scenario);
    CHECK(system.run_until_arrived(system.now() + 20s));
  }
}

TEST_CASE("a standby with different rules is reported within a second, and never takes over") {
  const RuleMutation& other = rule_mutations().at(GENERATE(range(std::size_t{0}, rule_mutations().size())));
  CAPTURE(other.key);
  Scenario scenario = crossing();
  scenario.coordinators = 2;
  SimSystem system(scenario, 3);
  Scenario changed = scenario;
  other.change(changed);
  system.run_for(500ms);
  replace(system, "coordinator 1", changed);
  system.run_for(1s);
  CHECK(differing_keys(system.metrics().report(), "coordinator 1") == std::vector{other.key});
  system.kill("coordinator");
  system.run_for(5s);
  CHECK(max_speed_mps(system) < 0.02);
  CHECK(system.metrics().arrived() < 8);
  system.restart("coordinator");
  CHECK(system.run_until_arrived(system.now() + 20s));
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  CHECK(report.audit->violations == 0);
}

TEST_CASE("a later agent with different rules does not take over its robot") {
  const Scenario scenario = crossing();
  SimSystem system(scenario, 4);
  Scenario changed = scenario;
  changed.radius_m = 0.05;
  system.run_for(500ms);
  system.use_scenario(twin_process(3), changed);
  system.restart(twin_process(3));
  CHECK(system.run_until_arrived(system.now() + 20s));
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  CHECK(report.audit->violations == 0);
  CHECK(differing_keys(report, "agent 3") == std::vector<std::string>{"radius_m"});
}

TEST_CASE(
    "an agent with different rules is refused and reported, and no robot drives until it has the same "
    "rules") {
  const Scenario scenario = crossing();
  SimSystem system(scenario, 5);
  Scenario changed = scenario;
  changed.margin_m = 0.05;
  replace(system, "agent 2", changed);
  system.run_for(3s);
  CHECK(max_speed_mps(system) < 0.02);
  CHECK(differing_keys(system.metrics().report(), "agent 2") == std::vector<std::string>{"margin_m"});
  replace(system, "agent 2", scenario);
  CHECK(system.run_until_arrived(system.now() + 20s));
}

TEST_CASE("observations of a vision process with a different roster are not used") {
  const Scenario scenario = crossing();
  SimSystem system(scenario, 6);
  system.run_for(1s);
  replace(system, "vision", without_robot(scenario, 0));
  system.run_for(5s);
  CHECK(max_speed_mps(system) < 0.02);
  CHECK(differing_keys(system.metrics().report(), "vision") == std::vector<std::string>{"robots.blue"});
  replace(system, "vision", scenario);
  CHECK(system.run_until_arrived(system.now() + 20s));
  CHECK(system.metrics().report().contacts == 0);
}

}  // namespace sidestep::rules_test
