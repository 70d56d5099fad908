// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/walk_sampler.hpp"

#include "deploy/trial/simulate/campaign/trial.hpp"
#include "tests/catch.hpp"

namespace sidestep::walk_sampler_test {

TEST_CASE("people in random scenes walk through buildings and touch neither walls nor obstacles") {
  int people = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = sample_trial(seed, std::chrono::seconds(60), std::nullopt).scenario;
    if (!scenario.map) continue;
    for (const OpponentSpec& person : scenario.opponents) {
      ++people;
      CHECK(person.speed_mps <= scenario.max_opponent_speed_mps);
      for (std::size_t i = 1; i < person.path_m.size(); ++i) {
        const Segment part{person.path_m[i - 1], person.path_m[i]};
        const double radius_m = person.radius_m - 1e-6;
        CHECK_FALSE(scenario.map->cells().touches(part.from_m, part.to_m, radius_m));
        CHECK(scenario.field.contains(part.to_m, radius_m));
        for (const Shape& obstacle : scenario.obstacles)
          CHECK(squared_distance(part, obstacle) >= radius_m * radius_m);
      }
      for (const RobotSpec& robot : scenario.robots)
        CHECK((robot.start_m - person.path_m.front()).norm() >= person.radius_m + scenario.radius_m);
    }
  }
  CHECK(people > 50);
}

TEST_CASE("a walk leaves out places that cannot be reached") {
  Scenario scenario;
  scenario.field = {4, 4};
  const bool is_divided = GENERATE(false, true);
  if (is_divided) scenario.obstacles = {Box{{-0.1, -2}, {0.1, 2}}};
  Rng rng(1);
  WalkSampler walks(scenario, 0.2, rng);
  const std::vector<Vec2> walk = walks.sample_walk({-1, 0}, 20);
  CHECK(walk.size() > 5);
  const bool crosses = std::ranges::any_of(walk, [](const Vec2& p) { return p.x() > 0; });
  CHECK(crosses != is_divided);
}

TEST_CASE("no free place is found for a disc that does not fit on the floor") {
  Scenario scenario;
  scenario.field = {1, 1};
  scenario.obstacles = {Circle{{0, 0}, 0.5}};
  Rng rng(1);
  CHECK_FALSE(WalkSampler(scenario, 0.3, rng).sample_free());
}

}  // namespace sidestep::walk_sampler_test
