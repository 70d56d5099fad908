// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <string>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/disturbance.hpp"
#include "tests/sim/ideal_floor.hpp"

namespace sidestep::clock_test {

Scenario circle_scenario(int robots, int coordinators = 1) {
  Scenario scenario = parse_scenario(
      "field: {length_m: 8, width_m: 8}\ncircle: {count: " + std::to_string(robots) + ", spacing_m: 0.5}\n",
      "circle_scenario.yaml");
  scenario.coordinators = coordinators;
  return scenario;
}

/// The agents' latest status messages.
struct Statuses {
  SimBus bus;
  std::map<RobotId, msg::AgentStatus> latest;
  std::map<std::uint32_t, std::uint64_t> implausible_clocks;

  explicit Statuses(SimNetwork& network) : bus(network) {
    bus.subscribe(topics::kStatus,
                  std::function([this](const msg::AgentStatus& s) { latest[s.robot()] = s; }));
    bus.subscribe(topics::kCounters, [this](const msg::Counters& message) {
      for (const msg::Counter& counter : message.counts()) {
        if (counter.reason() == static_cast<std::uint16_t>(DropReason::kImplausibleClock))
          implausible_clocks[message.process()] = counter.times();
      }
    });
  }
};

TEST_CASE(
    "a new agent forwards vision to a robot that has lost its pose, even if the agent's host has a wrong "
    "clock") {
  const double ahead_s = GENERATE(-4.0, 4.0);
  CAPTURE(ahead_s);
  const Scenario scenario = circle_scenario(4);
  ClockError error;
  error.offset = from_seconds(ahead_s);
  SimSystem system(scenario, 1, {{"agent 2", error}});
  system.run_for(std::chrono::milliseconds(1500));
  auto forget_pose = disturbance(2, msg::DisturbanceKind::DISTURBANCE_FORGET_POSE);
  system.disturb(forget_pose);
  // The new agent cannot measure the robot's clock, because the robot reports nothing.
  system.run_for(std::chrono::milliseconds(5));
  system.kill("agent 2");
  system.restart("agent 2");
  CHECK(system.run_until_arrived(system.now() + std::chrono::seconds(20)));
  CHECK(system.metrics().report().contacts == 0);
}

TEST_CASE("an agent forwards vision to a robot that has lost its pose, even if its clock was wrong before") {
  const double ahead_s = GENERATE(-4.0, 4.0);
  CAPTURE(ahead_s);
  Scenario scenario = circle_scenario(4);
  scenario.robots[2].clock_offset = from_seconds(ahead_s);
  SimSystem system(scenario, 1);
  system.run_for(std::chrono::milliseconds(2500));
  // The agent has measured the wrong clock. The robot restarts with the right one and without a pose, so it
  // reports nothing.
  system.disturb(disturbance(2, msg::DisturbanceKind::DISTURBANCE_FORGET_POSE));
  system.disturb(disturbance(2, msg::DisturbanceKind::DISTURBANCE_CLOCK));
  CHECK(system.run_until_arrived(system.now() + std::chrono::seconds(20)));
  CHECK(system.metrics().report().contacts == 0);
}

TEST_CASE("agents drive their robots although their hosts' clocks are wrong") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  IdealFloor floor(circle_scenario(6), seed);
  const double ahead_s[] = {0.05, -0.05, 2, -2, 3600, -900};
  for (const RobotSpec& robot : floor.scenario.robots) {
    floor.agent_buses(robot.id)[0]->set_clock_offset(from_seconds(ahead_s[robot.id]));
  }
  Statuses statuses(floor.network);
  CHECK(floor.run_until_arrived(20) >= floor.scenario.margin_m);
  CHECK(floor.arrived() == 6);
  CHECK(floor.violations() == 0);
  for (const auto& [robot, status] : statuses.latest) {
    CAPTURE(robot);
    CHECK(std::abs(status.clock_offset_s()) <= status.clock_uncertainty_s());
    CHECK(status.clock_uncertainty_s() < 0.002);
    CHECK(statuses.implausible_clocks[robot] <= 10);
  }
}

TEST_CASE(
    "robots whose clocks are within the bound reduce clearance by at most the clocks' share of the safety "
    "budget") {
  double smallest = 1;
  Scenario scenario = circle_scenario(16);
  const double shift_m = 2 * scenario.clock_bound_s * scenario.limits.speed_mps;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    IdealFloor floor(scenario, seed);
    for (const RobotSpec& robot : scenario.robots) {
      floor.robots.set_clock_offset(robot.id, from_seconds((robot.id % 2 ? 1 : -1) * scenario.clock_bound_s));
    }
    const double clearance = floor.run_until_arrived(20);
    REQUIRE(clearance >= scenario.margin_m - shift_m);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.arrived() == 16);
    smallest = std::min(smallest, clearance);
  }
  // If clock offsets had no effect on the clearance, the test would prove nothing.
  CHECK(smallest < scenario.margin_m);
}

TEST_CASE(
    "a robot whose clock is beyond the bound stands still while others drive, and continues once its clock "
    "is set") {
  const double ahead_s = GENERATE(0.005, -0.005, 0.3, -900.0);
  CAPTURE(ahead_s);
  IdealFloor floor(circle_scenario(4), 5);
  floor.robots.set_clock_offset(1, from_seconds(ahead_s));
  Statuses statuses(floor.network);
  const Vec2 before = floor.robots.position_m(1, floor.network.now());
  CHECK(floor.run(10) >= floor.scenario.margin_m);
  CHECK(floor.robots.position_m(1, floor.network.now()) == before);
  CHECK(floor.arrived() >= 2);
  const msg::AgentStatus& status = statuses.latest.at(1);
  CHECK(status.agent_state() == msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
  CHECK(std::abs(status.clock_offset_s() - ahead_s) <= status.clock_uncertainty_s());
  floor.robots.set_clock_offset(1, Duration{0});
  CHECK(floor.run_until_arrived(20) >= floor.scenario.margin_m);
  CHECK(floor.arrived() == 4);
  CHECK(floor.violations() == 0);
}

TEST_CASE(
    "robots stop when their coordinator's clock jumps, and continue under a standby with a correct clock") {
  IdealFloor floor(circle_scenario(6, 2), 7);
  REQUIRE(floor.run_until_speed(0.8));
  REQUIRE(floor.granting_coordinator() == 0);
  floor.coordinator_bus(0).set_clock_offset(from_seconds(0.1));
  // The next verdicts reveal the jump. Versions granted before the jump are still executed.
  (void)floor.run(0.1 + 2.0 / floor.scenario.limits.deceleration_mps2);
  CHECK(floor.max_speed_mps() == 0);
  (void)floor.run(3);
  CHECK(floor.max_speed_mps() == 0);
  CHECK(floor.arrived() == 0);
  floor.kill_coordinator(0);
  CHECK(floor.run_until_arrived(20) >= floor.scenario.margin_m);
  CHECK(floor.granting_coordinator() == 1);
  CHECK(floor.arrived() == 6);
  CHECK(floor.violations() == 0);
}

/// The results of runs with one delay.
struct SlowRuns {
  double max_offset_s = 0;     ///< largest offset of a robot's clock that the measured intervals permitted
  double min_clearance_m = 1;  ///< minimum distance of two robots' references, each by its robot's clock
  double max_makespan_s = 0;
};

/// Runs robots until they arrive. Every second robot's clock is ahead of the others' by 0.8 times the delay,
/// which round trips cannot reveal.
void drive_on_slow_network(Duration delay, std::uint64_t seed, SlowRuns& runs) {
  CAPTURE(seed);
  Scenario scenario = circle_scenario(16);
  scenario.network.delay_min = scenario.network.delay_max = delay;
  IdealFloor floor(scenario, seed);
  const double max_offset_s = 0.4 * to_seconds(delay);
  for (const RobotSpec& robot : scenario.robots)
    floor.robots.set_clock_offset(robot.id, from_seconds((robot.id % 2 ? 1 : -1) * max_offset_s));
  Statuses statuses(floor.network);
  const Time begin = floor.network.now();
  const double clearance_m = floor.run_until_arrived(300);
  REQUIRE(clearance_m >= 2 * scenario.tracking_bound_m);
  REQUIRE(floor.arrived() == 16);
  REQUIRE(floor.violations() == 0);
  for (const auto& [robot, status] : statuses.latest) {
    REQUIRE(status.agent_state() != msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
    const double offset_s = std::abs(status.clock_offset_s()) + status.clock_uncertainty_s();
    runs.max_offset_s = std::max(runs.max_offset_s, offset_s);
  }
  runs.min_clearance_m = std::min(runs.min_clearance_m, clearance_m);
  runs.max_makespan_s = std::max(runs.max_makespan_s, to_seconds(floor.network.now() - begin));
}

TEST_CASE(
    "on slow networks, which hide clock offsets, robots drive so slowly that the safety budget still holds") {
  constexpr int kSeeds = 10;
  std::string table = fmt::format("{:>8} {:>9} {:>12} {:>13} {:>11}\n", "delay ms", "apart ms", "possible ms",
                                  "clearance mm", "makespan s");
  std::vector<SlowRuns> rows;
  for (const double delay_ms : {0.5, 1.0, 2.0, 5.0, 10.0}) {
    CAPTURE(delay_ms);
    SlowRuns runs;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
      drive_on_slow_network(from_seconds(delay_ms / 1e3), seed, runs);
    table += fmt::format("{:8.1f} {:9.1f} {:12.2f} {:13.2f} {:11.1f}\n", delay_ms, 0.8 * delay_ms,
                         1e3 * runs.max_offset_s, 1e3 * runs.min_clearance_m, runs.max_makespan_s);
    rows.push_back(runs);
  }
  const Scenario scenario = circle_scenario(16);
  WARN("apart: true offset of the clocks, possible: largest offset that measurements cannot exclude\n"
       << table << "budget: at least " << 2e3 * scenario.tracking_bound_m << " mm, " << kSeeds
       << " seeds for each delay");
  // Shows that the delay has an effect.
  CHECK(rows.back().max_makespan_s > 10 * rows.front().max_makespan_s);
}

TEST_CASE(
    "a robot whose clock jumps while it drives breaks no rule, and drives again once the clock is set") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    SimSystem system(circle_scenario(8), seed);
    const double size_s = 0.001 * std::pow(3000, rng.uniform());
    const Duration at = from_seconds(rng.uniform(0.5, 2.5));
    const Duration error = from_seconds(rng.chance(0.5) ? size_s : -size_s);
    CAPTURE(to_seconds(at), to_seconds(error));
    auto clock = disturbance(3, msg::DisturbanceKind::DISTURBANCE_CLOCK);
    clock.clock_offset_ns(error.count());
    system.run_for(at);
    system.disturb(clock);
    system.run_for(std::chrono::seconds(4));
    clock.clock_offset_ns(0);
    system.disturb(clock);
    CHECK(system.run_until_arrived(system.now() + std::chrono::seconds(20)));
    const Report report = system.metrics().report();
    CHECK(report.audit->violations == 0);
    CHECK(report.unexcused_contacts() == 0);
  }
}

TEST_CASE("after a long wait, a robot continues only after the clocks have been measured again") {
  // A robot with a wrong clock rests at the other robot's goal until its clock is corrected.
  Scenario scenario = parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 0, team: blue, start_m: [-1, 0], goals_m: [[1, 0]]}\n"
      "  - {id: 1, team: blue, start_m: [1, 0], goals_m: [[1, 1]]}\n",
      "waiting.yaml");
  IdealFloor floor(scenario, 1);
  floor.robots.set_clock_offset(1, from_seconds(0.05));
  (void)floor.run(10);
  CHECK(floor.arrived() == 0);
  floor.robots.set_clock_offset(1, Duration{0});
  CHECK(floor.run_until_arrived(10) >= scenario.margin_m);
  CHECK(floor.arrived() == 2);
}

}  // namespace sidestep::clock_test
