// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <map>

#include "common/config/scenario_loader.hpp"
#include "tests/sim/ideal_floor.hpp"

using namespace sidestep;

namespace {

Scenario crowd(int robots, int coordinators = 1) {
  Scenario scenario = parse_scenario(
      "field: {length_m: 8, width_m: 8}\ncircle: {count: " + std::to_string(robots) + ", spacing_m: 0.5}\n",
      "crowd.yaml");
  scenario.coordinators = coordinators;
  return scenario;
}

/// What the agents say of themselves.
struct Statuses {
  SimBus bus;
  std::map<RobotId, msg::AgentStatus> latest;

  explicit Statuses(SimNetwork& network) : bus(network) {
    bus.subscribe(topics::kStatus,
                  std::function([this](const msg::AgentStatus& s) { latest[s.robot()] = s; }));
  }
};

}  // namespace

TEST_CASE("agents on hosts whose clocks are wrong drive their robots all the same") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  IdealFloor floor(crowd(6), seed);
  const double ahead_s[] = {0.05, -0.05, 2, -2, 3600, -900};
  for (const RobotSpec& robot : floor.scenario.robots) {
    floor.agent_buses(robot.id)[0]->set_clock_ahead(from_seconds(ahead_s[robot.id]));
  }
  Statuses statuses(floor.network);
  CHECK(floor.run_until_arrived(20) >= floor.scenario.margin_m);
  CHECK(floor.arrived() == 6);
  CHECK(floor.violations() == 0);
  for (const auto& [robot, status] : statuses.latest) {
    CAPTURE(robot);
    CHECK(std::abs(status.clock_offset_s()) <= status.clock_uncertainty_s());
    CHECK(status.clock_uncertainty_s() < 0.002);
    CHECK(status.invalid() <= 10);
  }
}

TEST_CASE(
    "robots whose clocks keep the bound come nearer than the margin by no more than the budget has for "
    "that") {
  double smallest = 1;
  Scenario scenario = crowd(16);
  const double shift_m = 2 * scenario.clock_bound_s * scenario.limits.speed_mps;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    IdealFloor floor(scenario, seed);
    for (const RobotSpec& robot : scenario.robots) {
      floor.robots.set_clock_ahead(robot.id, from_seconds((robot.id % 2 ? 1 : -1) * scenario.clock_bound_s));
    }
    const double clearance = floor.run_until_arrived(20);
    REQUIRE(clearance >= scenario.margin_m - shift_m);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.arrived() == 16);
    smallest = std::min(smallest, clearance);
  }
  // The clocks really cost something.
  CHECK(smallest < scenario.margin_m);
}

TEST_CASE(
    "a robot whose clock is beyond the bound is not driven, the others are, and it goes on once it is set") {
  const double ahead_s = GENERATE(0.005, -0.005, 0.3, -900.0);
  CAPTURE(ahead_s);
  IdealFloor floor(crowd(4), 5);
  floor.robots.set_clock_ahead(1, from_seconds(ahead_s));
  Statuses statuses(floor.network);
  const Vec2 before = floor.robots.position_m(1, floor.network.now());
  CHECK(floor.run(10) >= floor.scenario.margin_m);
  CHECK(floor.robots.position_m(1, floor.network.now()) == before);
  CHECK(floor.arrived() >= 2);
  const msg::AgentStatus& status = statuses.latest.at(1);
  CHECK(status.agent_state() == msg::AGENT_OFF_CLOCK);
  CHECK(std::abs(status.clock_offset_s() - ahead_s) <= status.clock_uncertainty_s());
  floor.robots.set_clock_ahead(1, Duration{0});
  CHECK(floor.run_until_arrived(20) >= floor.scenario.margin_m);
  CHECK(floor.arrived() == 4);
  CHECK(floor.violations() == 0);
}

TEST_CASE(
    "robots stop when their coordinator's clock jumps away, and a standby with a good clock drives them on") {
  IdealFloor floor(crowd(6, 2), 7);
  REQUIRE(floor.run_until_fast(0.8));
  REQUIRE(floor.granting() == 0);
  floor.coordinator_bus(0).set_clock_ahead(from_seconds(0.1));
  // Noticed with the next verdicts; what was granted by then is still driven.
  (void)floor.run(0.1 + 2.0 / floor.scenario.limits.deceleration_mps2);
  CHECK(floor.fastest_mps() == 0);
  (void)floor.run(3);
  CHECK(floor.fastest_mps() == 0);
  CHECK(floor.arrived() == 0);
  floor.kill_coordinator(0);
  CHECK(floor.run_until_arrived(20) >= floor.scenario.margin_m);
  CHECK(floor.granting() == 1);
  CHECK(floor.arrived() == 6);
  CHECK(floor.violations() == 0);
}

TEST_CASE("a robot that waits for long measures the clocks again before it moves on") {
  // The second goal is taken by a robot that stands there until its own clock is set right.
  Scenario scenario = parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 0, team: blue, start_m: [-1, 0], goals_m: [[1, 0]]}\n"
      "  - {id: 1, team: blue, start_m: [1, 0], goals_m: [[1, 1]]}\n",
      "waiting.yaml");
  IdealFloor floor(scenario, 1);
  floor.robots.set_clock_ahead(1, from_seconds(0.05));
  (void)floor.run(10);
  CHECK(floor.arrived() == 0);
  floor.robots.set_clock_ahead(1, Duration{0});
  CHECK(floor.run_until_arrived(10) >= scenario.margin_m);
  CHECK(floor.arrived() == 2);
}
