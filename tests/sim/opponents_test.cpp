// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "common/random/rng.hpp"
#include "deploy/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::opponents_test {

/// Samples positions on the floor with a minimum distance from each other.
struct PositionSampler {
  Rng& rng;
  const Field& field;
  std::vector<Vec2> taken;

  Vec2 sample_any() {
    const double x = field.length_m / 2 - 0.3, y = field.width_m / 2 - 0.3;
    return {rng.uniform(-x, x), rng.uniform(-y, y)};
  }
  Vec2 sample(double min_distance_m) {
    for (;;) {
      const Vec2 place = sample_any();
      const auto is_near = [&](const Vec2& other) { return (other - place).norm() < min_distance_m; };
      if (std::ranges::any_of(taken, is_near)) continue;
      taken.push_back(place);
      return place;
    }
  }
};

/// A few robots, and opponents on random routes with speeds up to the bound.
Scenario random_scene(std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "opponents";
  scenario.field = {6, 5};
  PositionSampler starts{rng, scenario.field, {}}, goals{rng, scenario.field, {}};
  const std::uint64_t robots = 3 + rng.below(6), opponents = 1 + rng.below(5);
  for (std::uint64_t i = 0; i < robots; ++i) {
    RobotSpec robot;
    robot.id = static_cast<RobotId>(i);
    robot.start_m = starts.sample(0.4);
    robot.goals = {{goals.sample(0.4), std::nullopt}};
    scenario.robots.push_back(robot);
  }
  for (std::uint64_t i = 0; i < opponents; ++i) {
    OpponentSpec opponent;
    opponent.radius_m = rng.uniform(0.06, 0.25);
    opponent.speed_mps = rng.chance(0.3) ? scenario.max_opponent_speed_mps : rng.uniform(0.2, 1.5);
    opponent.path_m.push_back(starts.sample(0.6));
    for (std::uint64_t k = 0; k < 1 + rng.below(3); ++k) opponent.path_m.push_back(starts.sample_any());
    scenario.opponents.push_back(opponent);
  }
  return scenario;
}

TEST_CASE("among random opponents no robot is moving when it is touched, over a hundred seeds") {
  std::uint64_t crashes = 0;
  int robots = 0, arrived = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = random_scene(seed);
    SimSystem system(scenario, seed);
    (void)system.run_until_arrived(system.begin() + from_seconds(20));
    const Report report = system.metrics().report();
    CHECK(report.contacts == 0);
    CHECK(report.crashes_while_moving == 0);
    CHECK(report.firmware_violations == 0);
    crashes += report.crashes;
    robots += report.robots;
    arrived += report.arrived;
  }
  CAPTURE(crashes, robots, arrived);
  WARN(arrived << " of " << robots << " robots arrived, " << crashes << " were touched at rest");
  // Without crashes the test would prove nothing; without arrivals robots that never move would pass.
  CHECK(crashes > 50);
  CHECK(arrived > robots / 2);
}

}  // namespace sidestep::opponents_test
