// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/campaign/forger.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::hostile_test {

using namespace std::chrono_literals;

constexpr RobotId kVictim = 3;

Scenario crossing() {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/crossing.yaml");
}

TEST_CASE("a single hostile message of any kind disturbs robots only briefly") {
  for (const Forgery& forgery : forgeries()) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      CAPTURE(forgery.name, seed);
      SimSystem system(crossing(), seed);
      Forger forger(system.network(), crossing(), kVictim);
      system.run_for(std::chrono::milliseconds(1200 + 300 * seed));
      forgery.change(forger);
      forger.send();
      CHECK(system.run_until_arrived(system.begin() + 20s));
      const Report report = system.metrics().report();
      CHECK(report.arrived == 8);
      CHECK(report.contacts == 0);
      if (!forgery.is_plausible_report) CHECK(report.audit->violations == 0);
      CHECK(report.makespan_s.value_or(99) < 8);
    }
  }
}

TEST_CASE("a hostile message of any kind does not keep a robot that has lost its pose from recovering") {
  Scenario scenario = crossing();
  scenario.tracking_bound_m = 0.014;
  scenario.margin_m = 0.032;
  for (const Forgery& forgery : forgeries()) {
    CAPTURE(forgery.name);
    SimSystem system(scenario, 1, {}, SimSystem::kBegin, bases_with_latency(100ms));
    Forger forger(system.network(), scenario, kVictim);
    system.run_for(2s);
    // Long enough for robots to lose their poses and for processes to accept another sender.
    system.pause("simulator", 2500ms, 0);
    system.run_for(2000ms);
    forgery.change(forger);
    forger.send();
    CHECK(system.run_until_arrived(system.now() + 20s));
    CHECK(system.metrics().report().arrived == 8);
  }
}

TEST_CASE("robots arrive although a hostile process keeps reporting higher epochs") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  SimSystem system(crossing(), seed);
  Forger forger(system.network(), crossing(), kVictim);
  system.run_for(1s);
  int sent = 0;
  while (!system.metrics().all_arrived() && system.now() < system.begin() + 15s) {
    forger.proposal().epoch(static_cast<Epoch>(to_ns(system.now() + 10s)));
    forger.send();
    ++sent;
    system.run_for(50ms);
  }
  const Report report = system.metrics().report();
  CHECK(sent > 20);
  CHECK(report.arrived == 8);
  CHECK(report.contacts == 0);
  CHECK(report.audit->violations == 0);
}

}  // namespace sidestep::hostile_test
