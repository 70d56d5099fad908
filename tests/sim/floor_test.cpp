// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "common/config/scenario_loader.hpp"
#include "deploy/sim_system.hpp"

using namespace sidestep;

namespace {

Scenario shipped(const std::string& name) {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/" + name + ".yaml");
}

/// Counts facts of robots off their references.
struct OffReference {
  OffReference(SimSystem& system, const Scenario& scenario) : bus(system.network()) {
    for (const RobotSpec& robot : scenario.robots) {
      bus.subscribe<msg::Feedback>(topics::kFeedback, robot.id, [this](const msg::Feedback& facts) {
        ++heard;
        count += facts.is_off_reference() ? 1 : 0;
      });
    }
  }
  SimBus bus;
  std::uint64_t heard = 0;
  std::uint64_t count = 0;
};

}  // namespace

TEST_CASE("in undisturbed runs no robot ever breaks off") {
  const auto [name, seeds] = GENERATE(
      table<const char*, std::uint64_t>({{"crossing-noisy", 20}, {"circle-100", 1}, {"two-teams-22", 3}}));
  const Scenario scenario = shipped(name);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    CAPTURE(name, seed);
    SimSystem system(scenario, seed);
    OffReference watch(system, scenario);
    CHECK(system.run_until_arrived(system.begin() + from_seconds(scenario.time_limit_s)));
    CHECK(watch.heard > 1000);
    CHECK(watch.count == 0);
  }
}
