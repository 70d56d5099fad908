// SPDX-License-Identifier: Apache-2.0
// Robots among a crowd of people, in scenes of many kinds.
#include <ctime>
#include <vector>

#include "common/random/rng.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/position_sampler.hpp"

namespace sidestep::crowd_test {

constexpr std::size_t kPeople = 32;

/// Samples the vision, the speed limits and the network of a scenario.
void sample_conditions(Scenario& scenario, Rng& rng) {
  scenario.radius_m = rng.uniform(0.06, 0.15);
  scenario.limits.speed_mps = rng.uniform(0.8, 2);
  scenario.limits.deceleration_mps2 = rng.uniform(3, 5);
  scenario.max_opponent_speed_mps = rng.uniform(0.3, 2.5);
  VisionSpec& vision = scenario.vision;
  vision.rate_hz = rng.uniform(30, 90);
  vision.columns = static_cast<int>(1 + rng.below(3));
  vision.rows = static_cast<int>(1 + rng.below(2));
  vision.overlap_m = rng.uniform(0.1, 0.6);
  vision.position_noise_m = rng.uniform(0.0001, 0.002);
  vision.delay = from_seconds(rng.uniform(0.002, 0.04));
  if (rng.chance(0.5)) vision.miss_probability = rng.uniform(0, 0.3);
  if (rng.chance(0.3)) vision.ghost_probability = rng.uniform(0, 0.1);
  NetworkSpec& network = scenario.network;
  if (rng.chance(0.5)) network.delay_max = network.delay_min + from_seconds(rng.uniform(0, 0.01));
  if (rng.chance(0.3)) network.loss = rng.uniform(0, 0.1);
}

/// Samples a person on a random route. Some people walk at the maximum speed that robots assume, others stand
/// still.
OpponentSpec sample_person(test::PositionSampler& starts, double min_distance_m, double max_speed_mps) {
  Rng& rng = starts.rng;
  OpponentSpec person;
  person.radius_m = rng.uniform(0.05, 0.3);
  person.speed_mps = rng.chance(0.2) ? max_speed_mps : rng.uniform(0.1, 1) * max_speed_mps;
  person.path_m.push_back(starts.sample(min_distance_m));
  for (std::uint64_t points = rng.below(5); points > 0; --points)
    person.path_m.push_back(starts.sample_any());
  if (person.path_m.size() > 2 && rng.chance(0.3)) person.path_m.push_back(person.path_m.front());
  return person;
}

Scenario crowded_scene(std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "crowd";
  scenario.field = {rng.uniform(7, 14), rng.uniform(6, 10)};
  sample_conditions(scenario, rng);
  test::PositionSampler starts{rng, scenario.field, {}}, goals{rng, scenario.field, {}};
  constexpr double kSeparation_m = 0.5;  // more than the sum of the largest radii and the margin
  for (std::uint64_t i = 0, robots = 2 + rng.below(7); i < robots; ++i) {
    RobotSpec robot;
    robot.id = static_cast<RobotId>(i);
    robot.start_m = starts.sample(kSeparation_m);
    robot.goals = {{goals.sample(kSeparation_m), std::nullopt}};
    scenario.robots.push_back(robot);
  }
  for (std::size_t i = 0; i < kPeople; ++i)
    scenario.opponents.push_back(sample_person(starts, kSeparation_m, scenario.max_opponent_speed_mps));
  return scenario;
}

struct Totals {
  std::uint64_t touched_at_rest = 0;
  int robots = 0, arrived = 0;
};

void drive_through_crowd(std::uint64_t seed, Totals& totals) {
  CAPTURE(seed);
  SimSystem system(crowded_scene(seed), seed);
  (void)system.run_until_arrived(system.begin() + from_seconds(12));
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  CHECK(report.crashes_while_moving == 0);
  CHECK(report.firmware_violations == 0);
  REQUIRE(report.audit);
  CHECK(report.audit->violations == 0);
  totals.touched_at_rest += report.crashes - report.crashes_while_moving;
  totals.robots += report.robots;
  totals.arrived += report.arrived;
}

void drive_through_crowds(std::uint64_t seeds) {
  const std::clock_t begin = std::clock();
  Totals totals;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) drive_through_crowd(seed, totals);
  const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  WARN(totals.arrived << " of " << totals.robots << " robots arrived, robots were touched "
                      << totals.touched_at_rest << " times at rest, " << cpu_s / static_cast<double>(seeds)
                      << " s per seed");
  // Without touches the test would prove nothing. Without arrivals, robots that never move would pass.
  CHECK(totals.touched_at_rest > seeds);
  CHECK(totals.arrived > totals.robots / 4);
}

TEST_CASE("no robot is moving when one of thirty-two people touches it, in twenty scenes") {
  drive_through_crowds(20);
}

TEST_CASE("no robot is moving when one of thirty-two people touches it, in two thousand scenes",
          "[.long][slow]") {
  drive_through_crowds(2000);
}

}  // namespace sidestep::crowd_test
