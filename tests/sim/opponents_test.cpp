// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "common/random/rng.hpp"
#include "deploy/simulate/system/sim_system.hpp"

using namespace sidestep;

namespace {

/// Places on the floor, each this far from those that are taken.
struct Places {
  Rng& rng;
  const Field& field;
  std::vector<Vec2> taken;

  Vec2 anywhere() {
    const double x = field.length_m / 2 - 0.3, y = field.width_m / 2 - 0.3;
    return {rng.uniform(-x, x), rng.uniform(-y, y)};
  }
  Vec2 take(double apart_m) {
    for (;;) {
      const Vec2 place = anywhere();
      const auto is_near = [&](const Vec2& other) { return (other - place).norm() < apart_m; };
      if (std::ranges::any_of(taken, is_near)) continue;
      taken.push_back(place);
      return place;
    }
  }
};

/// A few robots, and opponents that drive anywhere between them as fast as the bound allows.
Scenario random_scene(std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "opponents";
  scenario.field = {6, 5};
  Places starts{rng, scenario.field, {}}, goals{rng, scenario.field, {}};
  const std::uint64_t robots = 3 + rng.below(6), opponents = 1 + rng.below(5);
  for (std::uint64_t i = 0; i < robots; ++i) {
    RobotSpec robot;
    robot.id = static_cast<RobotId>(i);
    robot.start_m = starts.take(0.4);
    robot.goals = {{goals.take(0.4), std::nullopt}};
    scenario.robots.push_back(robot);
  }
  for (std::uint64_t i = 0; i < opponents; ++i) {
    OpponentSpec opponent;
    opponent.radius_m = rng.uniform(0.06, 0.25);
    opponent.speed_mps = rng.chance(0.3) ? scenario.opponent_speed_mps : rng.uniform(0.2, 1.5);
    opponent.path_m.push_back(starts.take(0.6));
    for (std::uint64_t k = 0; k < 1 + rng.below(3); ++k) opponent.path_m.push_back(starts.anywhere());
    scenario.opponents.push_back(opponent);
  }
  return scenario;
}

}  // namespace

TEST_CASE("among a hundred crowds of random opponents no robot is moving when it is touched") {
  std::uint64_t crashes = 0;
  int robots = 0, arrived = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = random_scene(seed);
    SimSystem system(scenario, seed);
    (void)system.run_until_arrived(system.begin() + from_seconds(20));
    const Report report = system.judge().report();
    CHECK(report.contacts == 0);
    CHECK(report.moving_crashes == 0);
    CHECK(report.firmware_violations == 0);
    crashes += report.crashes;
    robots += report.robots;
    arrived += report.arrived;
  }
  CAPTURE(crashes, robots, arrived);
  WARN(arrived << " of " << robots << " robots arrived, " << crashes << " were touched at rest");
  // Else nothing was tried, and a robot that never moves would pass as well.
  CHECK(crashes > 50);
  CHECK(arrived > robots / 2);
}
