// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/disturbance.hpp"

namespace sidestep::floor_test {

Scenario shipped(const std::string& name) {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/" + name + ".yaml");
}

/// Counts reports of robots that are off their references.
struct OffReference {
  OffReference(SimSystem& system, const Scenario& scenario) : bus(system.network()) {
    for (const RobotSpec& robot : scenario.robots) {
      bus.subscribe<msg::Feedback>(topics::kFeedback, robot.id, [this](const msg::Feedback& robot_report) {
        ++heard;
        count += robot_report.is_off_reference() ? 1 : 0;
        if (robot_report.is_off_reference() && !first_at) first_at = bus.now();
      });
    }
  }
  SimBus bus;
  std::uint64_t heard = 0;
  std::uint64_t count = 0;
  std::optional<Time> first_at;
};

TEST_CASE("robots drive in the corners of the largest floor") {
  Scenario scenario;
  scenario.name = "large floor";
  scenario.field = {1000, 1000};
  RobotId id = 0;
  for (const Vec2& corner : {Vec2(1, 1), Vec2(-1, 1), Vec2(-1, -1), Vec2(1, -1)})
    scenario.robots.push_back({.id = id++, .start_m = 499.5 * corner, .goals = {{497.5 * corner}}});
  SimSystem system(scenario, 1);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(15)));
  const Report report = system.metrics().report();
  CHECK(report.audit->verdict() == AuditVerdict::kPassed);
  CHECK(report.contacts == 0);
}

TEST_CASE("in undisturbed runs no robot is ever off its reference") {
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

TEST_CASE(
    "a pushed robot reports that it is off its reference within the latency of cameras and vision and "
    "radio") {
  const auto [name, max_ms] =
      GENERATE(table<const char*, int>({{"two-teams-22", 120}, {"crossing-noisy", 180}}));
  const double push_mps = GENERATE(0.5, 1.0);
  const Scenario scenario = shipped(name);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(name, push_mps, seed);
    SimSystem system(scenario, seed);
    OffReference watch(system, scenario);
    Writer<msg::Disturbance> disturbances = watch.bus.advertise(topics::kDisturbance);
    system.run_for(std::chrono::milliseconds(2000));
    REQUIRE(watch.count == 0);
    const Time pushed = system.now();
    auto push = disturbance(scenario.robots[0].id, msg::DisturbanceKind::DISTURBANCE_PUSH);
    push.vy_mps(push_mps);
    disturbances.publish(push, pushed);
    system.run_for(std::chrono::milliseconds(300));
    REQUIRE(watch.first_at);
    INFO("after " << to_seconds(*watch.first_at - pushed) * 1e3 << " ms");
    CHECK(*watch.first_at - pushed < std::chrono::milliseconds(max_ms));
    CHECK(system.metrics().report().firmware_violations == 0);
  }
}

TEST_CASE("among opponents every robot arrives, and is at rest whenever an opponent touches it") {
  Scenario scenario = shipped("opponents");
  // One opponent drives back and forth over the goals.
  scenario.opponents.at(1).path_m = {{3.45, 2.6}, {3.45, -2.6}};
  std::uint64_t crashes = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    SimSystem system(scenario, seed);
    CHECK(system.run_until_arrived(system.begin() + from_seconds(scenario.time_limit_s)));
    const Report report = system.metrics().report();
    CHECK(report.contacts == 0);
    for (const Violation& violation : report.audit->first) UNSCOPED_INFO(to_line(violation));
    CHECK(report.audit->violations == 0);
    CHECK(report.crashes_while_moving == 0);
    CHECK(report.max_robot_crash_speed_mps < 0.05);
    crashes += report.crashes;
  }
  CHECK(crashes > 0);  // without crashes the test would prove nothing
}

/// A system and a writer for disturbances.
struct Disturbed {
  Disturbed(const Scenario& s, std::uint64_t seed)
      : scenario(s),
        system(scenario, seed),
        bus(system.network()),
        disturbances(bus.advertise(topics::kDisturbance)) {}

  void send(msg::Disturbance message) { disturbances.publish(message, system.now()); }
  bool arrive_within(double seconds) {
    return system.run_until_arrived(system.now() + from_seconds(seconds));
  }

  Scenario scenario;
  SimSystem system;
  SimBus bus;
  Writer<msg::Disturbance> disturbances;
};

TEST_CASE("pushed or rebooted robots continue to their goals without contact") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Disturbed run(shipped("crossing"), seed);
    OffReference watch(run.system, run.scenario);
    run.system.run_for(std::chrono::milliseconds(1500));
    for (int i = 0; i < 6; ++i) {
      const auto kind =
          rng.chance(0.5) ? msg::DisturbanceKind::DISTURBANCE_PUSH : msg::DisturbanceKind::DISTURBANCE_REBOOT;
      msg::Disturbance message = disturbance(static_cast<RobotId>(rng.below(8)), kind);
      // After the push the robot slides by less than the margin.
      const Vec2 change = rotated(Vec2(0.3, 0), rng.uniform(-3.14, 3.14));
      message.vx_mps(change.x());
      message.vy_mps(change.y());
      run.send(message);
      run.system.run_for(from_seconds(rng.uniform(0.05, 0.5)));
    }
    CHECK(watch.count > 0);
    CHECK(run.arrive_within(30));
    const Report report = run.system.metrics().report();
    CHECK(report.contacts == 0);
    CHECK(report.firmware_violations == 0);
  }
}

TEST_CASE("robots continue to their goals after they slip or a wheel is blocked") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Disturbed run(shipped("crossing"), seed);
    run.system.run_for(std::chrono::milliseconds(1500));
    for (int i = 0; i < 4; ++i) {
      const auto kind =
          rng.chance(0.5) ? msg::DisturbanceKind::DISTURBANCE_SLIP : msg::DisturbanceKind::DISTURBANCE_BLOCK;
      msg::Disturbance message = disturbance(static_cast<RobotId>(rng.below(8)), kind);
      message.grip(rng.uniform(0.2, 0.8));
      message.heading_rad(rng.uniform(-3, 3));
      message.duration_ns(static_cast<std::int64_t>(rng.below(300'000'000)));
      run.send(message);
      run.system.run_for(from_seconds(rng.uniform(0.05, 0.5)));
    }
    CHECK(run.arrive_within(30));
    CHECK(run.system.metrics().report().firmware_violations == 0);
  }
}

TEST_CASE("a robot is taken off the floor and put down elsewhere while the other robots keep driving") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const bool begins_absent = GENERATE(false, true);
  CAPTURE(seed, begins_absent);
  Scenario scenario = shipped("crossing");
  scenario.robots[3].is_absent = begins_absent;
  Disturbed run(scenario, seed);
  std::size_t seen = 0;
  run.system.observer_bus().subscribe(topics::kTruth,
                                      [&](const msg::GroundTruth& truth) { seen = truth.robots().size(); });
  run.system.run_for(std::chrono::milliseconds(1500));
  CHECK(seen == (begins_absent ? 7 : 8));
  if (!begins_absent) run.send(disturbance(3, msg::DisturbanceKind::DISTURBANCE_LIFT));
  run.system.run_for(std::chrono::milliseconds(1500));
  CHECK(seen == 7);
  msg::Disturbance place = disturbance(3, msg::DisturbanceKind::DISTURBANCE_PLACE);
  place.x_m(-1.8);
  place.y_m(1.3);
  run.send(place);
  CHECK(run.arrive_within(30));
  CHECK(seen == 8);
  const Report report = run.system.metrics().report();
  CHECK(report.arrived == 8);
  CHECK(report.contacts == 0);
  CHECK(report.firmware_violations == 0);
}

}  // namespace sidestep::floor_test
