// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/sim_system.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::sim_system_test {

using namespace std::chrono_literals;

Scenario crossing() { return load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml"); }

/// The report of a run without machine-dependent values.
std::string outcome(SimSystem& system) {
  Report report = system.metrics().report();
  report.plan = report.search = DurationHistogram{};
  return to_json(report);
}

TEST_CASE("the same seed gives the same report and a different seed a different report") {
  Scenario scenario = crossing();
  scenario.network.loss = 0.1;
  std::string outcomes[3];
  const std::uint64_t seeds[] = {11, 11, 12};
  for (int i = 0; i < 3; ++i) {
    SimSystem system(scenario, seeds[i]);
    system.run_until_arrived(system.begin() + 60s);
    CHECK(system.metrics().report().contacts == 0);
    CHECK(system.auditor().totals().violations == 0);
    outcomes[i] = outcome(system);
  }
  CHECK(outcomes[0] == outcomes[1]);
  CHECK(outcomes[0] != outcomes[2]);
}

TEST_CASE("the robot of a killed agent comes to rest, and the other robots arrive") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  SimSystem system(crossing(), seed);
  while (!system.metrics().granting_since() && system.now() < system.begin() + 20s) system.run_for(10ms);
  system.run_for(1s);
  system.kill("agent 3");
  CHECK_FALSE(system.is_alive("agent 3"));
  system.run_for(1s);
  const auto row = [&] {
    for (const RobotProgress& progress : system.metrics().progress()) {
      if (progress.robot == 3) return progress;
    }
    FAIL("robot 3 is missing");
    return RobotProgress{};
  };
  CHECK(row().speed_mps < 0.02);
  const double distance_m = row().distance_to_go_m;
  CHECK(distance_m > 0.1);
  system.run_until_arrived(system.now() + 30s);
  CHECK(row().distance_to_go_m == Approx(distance_m).margin(0.01));
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  CHECK(report.audit->violations == 0);
  CHECK(report.firmware_violations == 0);
  REQUIRE(report.deaths.size() == 1);
  CHECK(report.deaths[0].process == "agent 3");
  CHECK(report.deaths[0].at_s == Approx(1).margin(0.1));
}

TEST_CASE("all robots arrive after a process is killed and restarted") {
  const std::string process = GENERATE("agent 5", "coordinator", "vision");
  CAPTURE(process);
  SimSystem system(crossing(), 4);
  while (!system.metrics().granting_since() && system.now() < system.begin() + 20s) system.run_for(10ms);
  system.run_for(1s);
  system.kill(process);
  system.run_for(1s);
  system.restart(process);
  CHECK(system.is_alive(process));
  CHECK(system.run_until_arrived(system.now() + 60s));
  CHECK(system.metrics().report().contacts == 0);
  CHECK(system.auditor().totals().violations == 0);
  CHECK(system.metrics().report().firmware_violations == 0);
}

TEST_CASE("with two coordinators all robots arrive although a coordinator dies") {
  const std::string process = GENERATE("coordinator", "coordinator 1");
  const bool comes_back = GENERATE(false, true);
  CAPTURE(process, comes_back);
  Scenario scenario = crossing();
  scenario.coordinators = 2;
  SimSystem system(scenario, 4);
  while (!system.metrics().granting_since() && system.now() < system.begin() + 20s) system.run_for(10ms);
  system.run_for(1s);
  system.kill(process);
  system.run_for(400ms);
  CHECK_FALSE(system.metrics().all_at_rest());
  if (comes_back) system.restart(process);
  CHECK(system.run_until_arrived(system.now() + 30s));
  CHECK(system.metrics().report().contacts == 0);
  CHECK(system.auditor().totals().violations == 0);
  CHECK(system.metrics().report().firmware_violations == 0);
  CHECK(system.metrics().report().deaths.at(0).process == process);
}

TEST_CASE("an unknown process cannot be started") {
  SimSystem system(crossing(), 1);
  CHECK_THROWS_WITH(system.restart("agent 99"), ContainsSubstring("no process \"agent 99\""));
  CHECK_THROWS_WITH(system.restart("coordinator 1"), ContainsSubstring("no process \"coordinator 1\""));
}

}  // namespace sidestep::sim_system_test
