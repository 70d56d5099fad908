// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/system/sim_system.hpp"

#include <catch2/catch.hpp>

#include "common/config/scenario_loader.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

Scenario crossing() { return load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml"); }

/// What a run leaves behind but for wall-clock figures.
std::string outcome(SimSystem& system) {
  Report report = system.judge().report();
  report.plan = report.search = DurationHistogram{};
  return to_json(report);
}

}  // namespace

TEST_CASE("one seed gives one run, another seed another") {
  Scenario scenario = crossing();
  scenario.network.loss = 0.1;
  std::string outcomes[3];
  const std::uint64_t seeds[] = {11, 11, 12};
  for (int i = 0; i < 3; ++i) {
    SimSystem system(scenario, seeds[i]);
    system.run_until_arrived(system.begin() + 60s);
    CHECK(system.judge().report().contacts == 0);
    CHECK(system.auditor().totals().violations == 0);
    outcomes[i] = outcome(system);
  }
  CHECK(outcomes[0] == outcomes[1]);
  CHECK(outcomes[0] != outcomes[2]);
}

TEST_CASE("an agent that is killed leaves its robot at rest, and the others arrive") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  SimSystem system(crossing(), seed);
  while (!system.judge().granting_since() && system.now() < system.begin() + 20s) system.run_for(10ms);
  system.run_for(1s);
  system.kill("agent 3");
  CHECK_FALSE(system.is_alive("agent 3"));
  system.run_for(1s);
  const auto row = [&] {
    for (const RobotProgress& progress : system.judge().progress()) {
      if (progress.robot == 3) return progress;
    }
    FAIL("no robot 3");
    return RobotProgress{};
  };
  CHECK(row().speed_mps < 0.02);
  const double left_m = row().distance_to_go_m;
  CHECK(left_m > 0.1);
  system.run_until_arrived(system.now() + 30s);
  CHECK(row().distance_to_go_m == Approx(left_m).margin(0.01));
  const Report report = system.judge().report();
  CHECK(report.contacts == 0);
  CHECK(report.audit->violations == 0);
  CHECK(report.firmware_violations == 0);
  REQUIRE(report.deaths.size() == 1);
  CHECK(report.deaths[0].process == "agent 3");
  CHECK(report.deaths[0].at_s == Approx(1).margin(0.1));
}

TEST_CASE("killed processes that are restarted bring everybody to their goals") {
  const std::string process = GENERATE("agent 5", "coordinator", "vision");
  CAPTURE(process);
  SimSystem system(crossing(), 4);
  while (!system.judge().granting_since() && system.now() < system.begin() + 20s) system.run_for(10ms);
  system.run_for(1s);
  system.kill(process);
  system.run_for(1s);
  system.restart(process);
  CHECK(system.is_alive(process));
  CHECK(system.run_until_arrived(system.now() + 60s));
  CHECK(system.judge().report().contacts == 0);
  CHECK(system.auditor().totals().violations == 0);
  CHECK(system.judge().report().firmware_violations == 0);
}

TEST_CASE("with two coordinators the death of either does not keep anybody from arriving") {
  const std::string process = GENERATE("coordinator", "coordinator 1");
  const bool comes_back = GENERATE(false, true);
  CAPTURE(process, comes_back);
  Scenario scenario = crossing();
  scenario.coordinators = 2;
  SimSystem system(scenario, 4);
  while (!system.judge().granting_since() && system.now() < system.begin() + 20s) system.run_for(10ms);
  system.run_for(1s);
  system.kill(process);
  system.run_for(400ms);
  CHECK_FALSE(system.judge().all_at_rest());
  if (comes_back) system.restart(process);
  CHECK(system.run_until_arrived(system.now() + 30s));
  CHECK(system.judge().report().contacts == 0);
  CHECK(system.auditor().totals().violations == 0);
  CHECK(system.judge().report().firmware_violations == 0);
  CHECK(system.judge().report().deaths.at(0).process == process);
}

TEST_CASE("a process that the system does not have cannot be started") {
  SimSystem system(crossing(), 1);
  CHECK_THROWS_WITH(system.restart("agent 99"), Catch::Contains("no process \"agent 99\""));
  CHECK_THROWS_WITH(system.restart("coordinator 1"), Catch::Contains("no process \"coordinator 1\""));
}

}  // namespace sidestep
