// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <optional>

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
        if (facts.is_off_reference() && !first_at) first_at = bus.now();
      });
    }
  }
  SimBus bus;
  std::uint64_t heard = 0;
  std::uint64_t count = 0;
  std::optional<Time> first_at;
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

TEST_CASE("a robot that is pushed says so as soon as cameras, vision and radio let it") {
  const auto [name, most_ms] =
      GENERATE(table<const char*, int>({{"two-teams-22", 120}, {"crossing-noisy", 180}}));
  const double push_mps = GENERATE(0.5, 1.0);
  const Scenario scenario = shipped(name);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(name, push_mps, seed);
    SimSystem system(scenario, seed);
    OffReference watch(system, scenario);
    Writer<msg::Disturbance> hand = watch.bus.advertise(topics::kDisturbance);
    system.run_for(std::chrono::milliseconds(2000));
    REQUIRE(watch.count == 0);
    const Time pushed = system.now();
    msg::Disturbance push;
    push.robot(scenario.robots[0].id);
    push.disturbance_kind(msg::DISTURBANCE_PUSH);
    push.vy_mps(push_mps);
    hand.publish(push, pushed);
    system.run_for(std::chrono::milliseconds(300));
    REQUIRE(watch.first_at);
    INFO("after " << to_seconds(*watch.first_at - pushed) * 1e3 << " ms");
    CHECK(*watch.first_at - pushed < std::chrono::milliseconds(most_ms));
    CHECK(system.judge().report().firmware_violations == 0);
  }
}

TEST_CASE("among opponents every robot arrives, and whoever is touched is at rest") {
  const Scenario scenario = shipped("opponents");
  std::uint64_t crashes = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    SimSystem system(scenario, seed);
    CHECK(system.run_until_arrived(system.begin() + from_seconds(scenario.time_limit_s)));
    const Report report = system.judge().report();
    CHECK(report.contacts == 0);
    CHECK(report.moving_crashes == 0);
    CHECK(report.robot_crash_speed_mps < 0.05);
    crashes += report.crashes;
  }
  CHECK(crashes > 0);  // else nothing was tried
}
