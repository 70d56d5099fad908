// SPDX-License-Identifier: Apache-2.0
// The protocol under external events: pushed, lifted and placed robots,
// firmware restarts, forged reports.
#include <algorithm>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"
#include "tests/sim/ideal_floor.hpp"

namespace sidestep::disturbance_test {

Scenario circle_scenario(int robots, int coordinators = 1) {
  return parse_scenario("coordinators: " + std::to_string(coordinators) +
                            "\nfield: {length_m: 8, width_m: 8}\ncircle: {count: " + std::to_string(robots) +
                            ", spacing_m: 0.6}\n",
                        "circle.yaml");
}

std::string robot(int id, const std::string& start, const std::string& goal, const std::string& more = "") {
  return "  - {id: " + std::to_string(id) + ", start_m: " + start + ", goals_m: [" + goal + "]" + more +
         "}\n";
}

Vec2 random_vector(Rng& rng, double max) {
  const double angle_rad = rng.uniform(0, 6.283);
  return rotated(Vec2(rng.uniform(0, max), 0), angle_rad);
}

Epoch highest_epoch(IdealFloor& floor) {
  Epoch highest = 0;
  for (int number = 0; number < floor.scenario.coordinators; ++number)
    highest = std::max(highest, floor.coordinator(static_cast<CoordinatorNumber>(number)).epoch());
  return highest;
}

TEST_CASE("pushed robots stop, and all robots reach their goals in the same epoch") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    IdealFloor floor(circle_scenario(8), seed);
    Rng rng(seed);
    REQUIRE(floor.run_until_speed(0.5));
    const Epoch epoch = highest_epoch(floor);
    for (int i = 0; i < 15; ++i) {
      const auto pushed = static_cast<RobotId>(rng.below(8));
      const Vec2 shift = random_vector(rng, 0.04), velocity = random_vector(rng, 1.0);
      floor.robots.push(pushed, shift, velocity, 0.01);
      (void)floor.run(rng.uniform(0.02, 0.5));
    }
    (void)floor.run_until_arrived(30);
    (void)floor.run(0.5);
    REQUIRE(floor.arrived() == 8);
    REQUIRE(floor.unknown_versions() == 0);
    REQUIRE(highest_epoch(floor) == epoch);
    REQUIRE(floor.coordinator(0).ledger().conflicts().empty());
    for (const RobotSpec& spec : floor.scenario.robots) {
      for (const Version& version : floor.coordinator(0).ledger().versions(spec.id))
        CHECK(version.inflation_m == 0);
    }
  }
}

TEST_CASE("a robot pushed too close to another is in conflict with it until they have moved apart") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const bool takes_over = seed % 2 == 0;
    IdealFloor floor(parse_scenario("coordinators: 2\nfield: {length_m: 6, width_m: 4}\nrobots:\n" +
                                        robot(1, "[-1, 0]", "[1, 0.3]") + robot(2, "[0, 0.5]", "[0, 0.5]"),
                                    "two.yaml"),
                     seed);
    REQUIRE(floor.run_until_speed(0.5));
    // Closer than the margin, but not in contact.
    const Time now = floor.network.now();
    const Vec2 close = floor.robots.position_m(2, now) + rotated(Vec2(0.182, 0), rng.uniform(3.2, 6.2));
    floor.robots.push(1, close - floor.robots.position_m(1, now), {0, 0}, 0.001);
    double clearance = floor.run(0.005);
    REQUIRE(floor.granting_coordinator() == 0);
    CHECK(floor.coordinator(0).state().conflicts() == 1);
    CHECK(floor.coordinator(0).state().conflict_first() == 1);
    CHECK(floor.coordinator(0).state().conflict_second() == 2);
    // A new coordinator that inherits the conflict also resolves it.
    if (takes_over) floor.kill_coordinator(0);
    clearance = std::min(clearance, floor.run_until_arrived(10));
    CHECK(clearance >= 0.002 - 1e-6);
    CHECK(floor.arrived() == 2);
    CHECK(floor.unknown_versions() == 0);
    CHECK(floor.coordinator(takes_over ? 1 : 0).ledger().conflicts().empty());
  }
}

TEST_CASE("a robot whose firmware restarts reaches its goal in the same epoch") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Scenario scenario = circle_scenario(6);
    scenario.network.loss = 0.1;
    scenario.network.duplicate = 0.1;
    scenario.network.delay_max = std::chrono::milliseconds(30);
    IdealFloor floor(scenario, seed);
    Rng rng(seed);
    REQUIRE(floor.run_until_speed(0.3));
    const Epoch epoch = highest_epoch(floor);
    for (int i = 0; i < 8; ++i) {
      floor.robots.reboot(static_cast<RobotId>(rng.below(6)));
      (void)floor.run(rng.uniform(0.05, 0.6));
    }
    (void)floor.run_until_arrived(40);
    REQUIRE(floor.arrived() == 6);
    REQUIRE(floor.unknown_versions() == 0);
    REQUIRE(highest_epoch(floor) == epoch);
  }
}

TEST_CASE("a forged report quarantines a robot only briefly, and all robots continue in the same epoch") {
  IdealFloor floor(circle_scenario(8, 2), 3);
  SimBus attacker(floor.network);
  auto writer = attacker.advertise(topics::kFeedback, 2);
  REQUIRE(floor.run_until_speed(0.5));
  const Epoch epoch = floor.coordinator(0).epoch();
  msg::Feedback feedback;
  feedback.robot(2);
  feedback.header().sender(2);
  feedback.executing().robot(2);
  feedback.executing().version_number(floor.coordinator(0).ledger().versions(2).back().number + 1'000'000);
  feedback.executing().x_m(3);
  feedback.executing().y_m(3);
  feedback.valid_at_ns(to_ns(floor.network.now()));
  writer.publish(feedback, floor.network.now());
  double clearance = floor.run(0.002);
  CHECK(floor.coordinator(0).ledger().is_quarantined(2));
  CHECK(floor.coordinator(0).is_granting());
  clearance = std::min(clearance, floor.run(0.5));
  CHECK(floor.coordinator(0).ledger().is_quarantined(2));
  CHECK(floor.speed_mps(2) == 0);
  CHECK(floor.max_speed_mps() > 0);
  clearance = std::min(clearance, floor.run_until_arrived(20));
  CHECK_FALSE(floor.coordinator(0).ledger().is_quarantined(2));
  CHECK(floor.coordinator(0).epoch() == epoch);
  CHECK(floor.arrived() == 8);
  CHECK(clearance >= floor.scenario.margin_m);
  CHECK(floor.unknown_versions() == 0);
}

TEST_CASE("a robot that computes in single precision is quarantined and reported, and the others arrive") {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    CAPTURE(seed);
    IdealFloor floor(circle_scenario(8, 2), seed);
    const auto imprecise = static_cast<RobotId>(seed);
    floor.robots.round_versions(imprecise);
    REQUIRE(floor.run_until_speed(0.5));
    double clearance = floor.run(0.2);
    REQUIRE(floor.granting_coordinator() == 0);
    CHECK(floor.coordinator(0).ledger().is_quarantined(imprecise));
    const auto state = floor.coordinator(0).state();
    REQUIRE(state.notices().size() == 1);
    CHECK(state.notices()[0].robot() == imprecise);
    CHECK(state.notices()[0].is_quarantined());
    const Epoch epoch = highest_epoch(floor);
    clearance = std::min(clearance, floor.run(20));
    CHECK(highest_epoch(floor) == epoch);
    // The quarantined robot rests at the goal of the opposite robot, so neither arrives.
    CHECK(floor.arrived() == 6);
    // Rounding moves the robot by less than a micrometre.
    CHECK(clearance >= floor.scenario.margin_m - 1e-6);
  }
}

TEST_CASE("lifted robots are put down with full margins while agents and coordinators restart") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Scenario scenario = circle_scenario(8, 2);
    if (seed % 2 == 0) {
      scenario.network.loss = 0.1;
      scenario.network.duplicate = 0.1;
      scenario.network.delay_max = std::chrono::milliseconds(40);
    }
    IdealFloor floor(scenario, seed);
    Rng rng(seed);
    REQUIRE(floor.run_until_speed(0.3));
    double clearance = 1;
    for (int round = 0; round < 6; ++round) {
      const auto lifted = static_cast<RobotId>(rng.below(8));
      floor.robots.lift(lifted);
      clearance = std::min(clearance, floor.run(rng.uniform(0.05, 0.4)));
      REQUIRE_FALSE(floor.robots.is_on_floor(lifted));
      const auto killed = static_cast<CoordinatorNumber>(rng.below(2));
      if (round % 3 == 1) floor.kill_coordinator(killed);
      if (round % 3 == 2) {
        floor.kill_agents(lifted);
        floor.start_agent(lifted);
      }
      clearance = std::min(clearance, floor.run(rng.uniform(0.05, 0.5)));
      REQUIRE_FALSE(floor.robots.is_on_floor(lifted));
      // Tries random positions. A request is refused if another robot may be at its position.
      const Time requested = floor.network.now();
      while (!floor.robots.is_on_floor(lifted) &&
             floor.network.now() < requested + std::chrono::seconds(20)) {
        floor.robots.place(lifted, random_vector(rng, 1.0));
        clearance = std::min(clearance, floor.run(rng.uniform(0.1, 1.0)));
      }
      REQUIRE(floor.robots.is_on_floor(lifted));
      // Nobody lifts a robot again before it could report that it stands.
      clearance = std::min(clearance, floor.run(0.1));
      if (round % 3 == 1) floor.start_coordinator(killed);
    }
    clearance = std::min(clearance, floor.run_until_arrived(40));
    REQUIRE(clearance >= scenario.margin_m);
    REQUIRE(floor.arrived() == 8);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.unknown_versions() == 0);
  }
}

TEST_CASE("an absent robot does not block others, and drives once it is put down on the floor") {
  // The corridor is wide enough for only one robot.
  IdealFloor floor(
      parse_scenario("field: {length_m: 6, width_m: 0.5}\nrobots:\n" + robot(1, "[-2, 0]", "[2, 0]") +
                         robot(2, "[0, 0]", "[-1, 0]", ", absent: true"),
                     "join.yaml"),
      1);
  (void)floor.run(0.2);
  CHECK(floor.coordinator(0).state().absent() == 1);
  // The absent robot's start position is free, so the other robot drives through it.
  for (int i = 0; i < 600 && floor.arrived() < 1; ++i) (void)floor.run(0.01);
  CHECK((floor.robots.position_m(1, floor.network.now()) - Vec2(2, 0)).norm() < 0.02);
  floor.robots.place(2, {2, 0.05});  // the place where the other robot rests
  (void)floor.run(1);
  CHECK_FALSE(floor.robots.is_on_floor(2));
  floor.robots.place(2, {1, 0});
  (void)floor.run(0.2);
  REQUIRE(floor.robots.is_on_floor(2));
  CHECK(floor.coordinator(0).state().absent() == 0);
  CHECK(floor.run_until_arrived(10) >= floor.scenario.margin_m);
  CHECK(floor.arrived() == 2);
}

}  // namespace sidestep::disturbance_test
