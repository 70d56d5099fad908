// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"
#include "tests/sim/ideal_floor.hpp"

namespace sidestep::protocol_test {

Scenario circle_scenario(int robots) {
  return parse_scenario(
      "field: {length_m: 8, width_m: 8}\ncircle: {count: " + std::to_string(robots) + ", spacing_m: 0.4}\n",
      "circle.yaml");
}

TEST_CASE("ideal robots keep their margin through loss, delay, duplicates and reordering") {
  Scenario scenario = circle_scenario(12);
  struct Network {
    double loss, duplicate, delay_max_s;
  };
  const auto [loss, duplicate, delay_max_s] = GENERATE(Network{0, 0, 0.001}, Network{0.1, 0.05, 0.02},
                                                       Network{0.3, 0.2, 0.15}, Network{0.6, 0.5, 0.05});
  scenario.network.loss = loss;
  scenario.network.duplicate = duplicate;
  scenario.network.delay_min = Duration{0};
  scenario.network.delay_max = from_seconds(delay_max_s);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(loss, duplicate, delay_max_s, seed);
    IdealFloor run(scenario, seed);
    const double clearance = run.run(15);
    REQUIRE(clearance >= scenario.margin_m);
    REQUIRE(run.violations() == 0);
    if (loss == 0) REQUIRE(run.arrived() == 12);
  }
}

TEST_CASE("an undisturbed robot never brakes for lack of a verdict") {
  Scenario scenario = parse_scenario(
      "field: {length_m: 8, width_m: 4}\nrobots:\n  - {id: 7, team: blue, start_m: [-3, 0], goals_m: [[3, "
      "0]]}\n",
      "alone.yaml");
  IdealFloor run(scenario, 1);
  const Time begin = run.network.now();
  Vec2 last = run.robots.position_m(7, begin);
  double speed = 0;
  int slower = 0;
  double peak = 0;
  while (run.arrived() == 0 && run.network.now() < begin + from_seconds(10)) {
    (void)run.run(0.02);
    const Vec2 here = run.robots.position_m(7, run.network.now());
    const double now_mps = (here - last).norm() / 0.02;
    // Counts braking, except for the stop at the goal.
    slower += now_mps < speed - 0.02 && (here - Vec2(3, 0)).norm() > 0.55;
    peak = std::max(peak, now_mps);
    speed = now_mps;
    last = here;
  }
  CHECK(run.arrived() == 1);
  CHECK(slower == 0);
  CHECK(peak == Approx(scenario.limits.speed_mps).margin(0.02));
}

TEST_CASE("neither of two crossing robots with equal claims always yields") {
  // Two robots drive to the crossing of their paths almost simultaneously, starting at a random time of the
  // control cycle.
  int won[2] = {0, 0};
  Rng rng(1);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::uint64_t first_id = 1 + seed % 2;
    const auto text = [&](std::uint64_t id, const std::string& start, const std::string& goal) {
      return "  - {id: " + std::to_string(id) + ", team: blue, start_m: " + start + ", goals_m: [" + goal +
             "]}\n";
    };
    const std::string offset = std::to_string(-1.2 + rng.uniform(-0.05, 0.05));
    IdealFloor run(parse_scenario("field: {length_m: 4, width_m: 4}\nrobots:\n" +
                                      text(first_id, "[" + offset + ", 0]", "[1.2, 0]") +
                                      text(3 - first_id, "[0, -1.2]", "[0, 1.2]"),
                                  "cross.yaml"),
                   seed);
    const double begins_s = rng.uniform(0, 40);
    const auto begin = [&](IdealFloor& floor) {
      floor.kill_coordinator(0);
      (void)floor.run(begins_s);
      floor.start_coordinator(0);
    };
    begin(run);
    (void)run.run(10);
    REQUIRE(run.arrived() == 2);
    IdealFloor again(run.scenario, seed);
    begin(again);
    while (again.arrived() == 0) (void)again.run(0.02);
    for (const RobotSpec& robot : run.scenario.robots) {
      const Vec2 here = again.robots.position_m(robot.id, again.network.now());
      won[robot.id - 1] += (here - robot.goals.back().position_m).norm() < run.scenario.goal_tolerance_m;
    }
  }
  CAPTURE(won[0], won[1]);
  CHECK(won[0] >= 8);
  CHECK(won[1] >= 8);
}

}  // namespace sidestep::protocol_test
