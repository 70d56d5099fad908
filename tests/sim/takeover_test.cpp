// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/ideal_floor.hpp"

namespace sidestep::takeover_test {

Scenario circle_scenario(int robots, int coordinators) {
  return parse_scenario("coordinators: " + std::to_string(coordinators) +
                            "\nfield: {length_m: 8, width_m: 8}\ncircle: {count: " + std::to_string(robots) +
                            ", spacing_m: 0.4}\n",
                        "circle.yaml");
}

/// Returns the time from a kill until a robot accelerates again; call it right after the kill. The first two
/// cycles do not count, because versions granted before the kill may still begin.
double seconds_until_faster(IdealFloor& floor) {
  const Time killed = floor.network.now();
  (void)floor.run(2.1 * to_seconds(floor.scenario.cycle));
  std::map<RobotId, double> speeds;
  for (const RobotSpec& robot : floor.scenario.robots) speeds[robot.id] = floor.speed_mps(robot.id);
  while (floor.network.now() < killed + std::chrono::seconds(5)) {
    (void)floor.run(0.001);
    for (auto& [robot, last] : speeds) {
      const double now = floor.speed_mps(robot);
      if (now > last + 1e-6) return to_seconds(floor.network.now() - killed);
      last = now;
    }
  }
  return 5;
}

TEST_CASE("the standby takes over when the active coordinator dies, and robots accelerate within 300 ms") {
  std::vector<double> seconds;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    IdealFloor floor(circle_scenario(12, 2), seed);
    REQUIRE(floor.run_until_speed(1.0));
    REQUIRE(floor.granting_coordinator() == 0);
    (void)floor.run(0.02 * static_cast<double>(seed) / 20);
    floor.kill_coordinator(0);
    seconds.push_back(seconds_until_faster(floor));
    REQUIRE(floor.granting_coordinator() == 1);
    REQUIRE(floor.run_until_arrived(20) >= floor.scenario.margin_m);
    REQUIRE(floor.arrived() == 12);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.unknown_versions() == 0);
  }
  std::ranges::sort(seconds);
  CAPTURE(seconds);
  CHECK(seconds.back() < 0.3);
  WARN("robots accelerate again " << seconds[10] * 1e3 << " ms after the kill (median of 20), at most "
                                  << seconds.back() * 1e3 << " ms");
}

TEST_CASE("coordinators that repeatedly die and restart delay robots but cause no contact") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    IdealFloor floor(circle_scenario(10, 3), seed);
    Rng rng(seed);
    double clearance = 1;
    for (int round = 0; round < 8; ++round) {
      clearance = std::min(clearance, floor.run(rng.uniform(0.3, 1.5)));
      const auto number = static_cast<CoordinatorNumber>(rng.below(3));
      floor.kill_coordinator(number);
      clearance = std::min(clearance, floor.run(rng.uniform(0.05, 0.6)));
      floor.start_coordinator(number);
    }
    clearance = std::min(clearance, floor.run_until_arrived(20));
    REQUIRE(clearance >= floor.scenario.margin_m);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.unknown_versions() == 0);
    REQUIRE(floor.arrived() == 10);
  }
}

TEST_CASE("a coordinator that is suspended and resumed causes no contact and becomes a standby") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    IdealFloor floor(circle_scenario(12, 2), seed);
    Rng rng(seed);
    REQUIRE(floor.run_until_speed(rng.uniform(0.3, 1.5)));
    const Epoch first = floor.coordinator(0).epoch();
    floor.coordinator_bus(0).stop();
    double clearance = floor.run(rng.uniform(0.2, 1.5));
    REQUIRE(floor.granting_coordinator() != 0);
    REQUIRE(floor.coordinator(0).epoch() == first);
    floor.coordinator_bus(0).resume();
    clearance = std::min(clearance, floor.run(0.1));
    CHECK_FALSE(floor.coordinator(0).is_active());
    // Then the second coordinator is suspended, and the first one takes over again.
    floor.coordinator_bus(1).stop();
    clearance = std::min(clearance, floor.run(0.6));
    CHECK(floor.coordinator(0).is_granting());
    CHECK(floor.coordinator(0).epoch() > first);
    floor.coordinator_bus(1).resume();
    clearance = std::min(clearance, floor.run_until_arrived(20));
    REQUIRE(clearance >= floor.scenario.margin_m);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.unknown_versions() == 0);
    REQUIRE(floor.arrived() == 12);
  }
}

TEST_CASE("robots arrive although coordinators do not receive each other's heartbeats") {
  const bool is_mutual = GENERATE(false, true);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CAPTURE(is_mutual, seed);
    IdealFloor floor(circle_scenario(10, 2), seed);
    REQUIRE(floor.run_until_speed(0.5));
    floor.coordinator_bus(1).block_topic("coordinator");
    if (is_mutual) floor.coordinator_bus(0).block_topic("coordinator");
    const double clearance = floor.run_until_arrived(30);
    REQUIRE(clearance >= floor.scenario.margin_m);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.unknown_versions() == 0);
    REQUIRE(floor.arrived() == 10);
  }
}

TEST_CASE(
    "one-way partitions of agents and coordinators stop robots for a while but never reduce clearance") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Scenario scenario = circle_scenario(10, 2);
    scenario.network.loss = 0.05;
    scenario.network.duplicate = 0.05;
    scenario.network.delay_max = std::chrono::milliseconds(20);
    IdealFloor floor(scenario, seed, AuditInput{});
    Rng rng(seed);
    double clearance = floor.run(1.5);
    for (int round = 0; round < 12; ++round) {
      std::vector<FaultyBus*> buses{&floor.coordinator_bus(0), &floor.coordinator_bus(1)};
      for (const RobotSpec& robot : scenario.robots) buses.push_back(floor.agent_buses(robot.id).front());
      for (FaultyBus* bus : buses) {
        bus->block_incoming(rng.chance(0.15));
        bus->block_outgoing(rng.chance(0.15));
      }
      clearance = std::min(clearance, floor.run(rng.uniform(0.05, 0.8)));
      for (FaultyBus* bus : buses) {
        bus->block_incoming(false);
        bus->block_outgoing(false);
      }
      clearance = std::min(clearance, floor.run(rng.uniform(0.05, 0.5)));
    }
    clearance = std::min(clearance, floor.run_until_arrived(30));
    REQUIRE(clearance >= floor.scenario.margin_m);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.unknown_versions() == 0);
    REQUIRE(floor.arrived() == 10);
  }
}

TEST_CASE("a forged epoch causes one change of epoch if it is plausible, and no change otherwise") {
  IdealFloor floor(circle_scenario(8, 2), 1);
  SimBus attacker(floor.network);
  auto writer = attacker.advertise(topics::kCoordinator);
  msg::CoordinatorState state;
  state.coordinator(5);
  state.header().sender(10005);
  state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  REQUIRE(floor.run_until_speed(0.5));
  const Epoch before = floor.coordinator(0).epoch();
  for (const Epoch hostile : {(Epoch{1} << 62) - 1, Epoch{1} << 61, ~Epoch{0}}) {
    state.epoch(hostile);
    writer.publish(state, floor.network.now());
    (void)floor.run(0.05);
    CHECK(floor.coordinator(0).epoch() == before);
    CHECK(floor.granting_coordinator() == 0);
  }
  const Time now = floor.network.now();
  state.epoch(static_cast<Epoch>(to_ns(now + std::chrono::minutes(59))));
  writer.publish(state, now);
  (void)floor.run(0.02);
  CHECK(floor.granting_coordinator() == -1);
  (void)floor.run(0.4);
  CHECK(floor.granting_coordinator() >= 0);
  CHECK(floor.run_until_arrived(20) >= floor.scenario.margin_m);
  CHECK(floor.arrived() == 8);
}

TEST_CASE("standbys do not replace a coordinator that serves, even if slow messages slow the robots down") {
  for (const double delay_ms : {0.2, 0.6, 1.0, 3.0}) {
    const int coordinators = GENERATE(2, 4);
    CAPTURE(delay_ms, coordinators);
    const Scenario scenario =
        parse_scenario("coordinators: " + std::to_string(coordinators) + "\nnetwork: {delay_min_ms: " +
                           std::to_string(delay_ms) + ", delay_max_ms: " + std::to_string(delay_ms) +
                           "}\nfield: {length_m: 8, width_m: 8}\ncircle: {count: 10, spacing_m: 0.4}\n",
                       "circle.yaml");
    SimSystem system(scenario, 1);
    system.run_for(std::chrono::seconds(12));
    const Report report = system.metrics().report();
    CHECK(report.epochs.size() == 1);
    CHECK(report.arrived == 10);
    CHECK(report.contacts == 0);
    CHECK(report.audit->violations == 0);
  }
}

}  // namespace sidestep::takeover_test
