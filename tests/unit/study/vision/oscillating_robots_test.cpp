// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/oscillating_robots.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::oscillating_robots_test {

TEST_CASE("oscillating robots stay on the field and apart, and their velocities match their motion") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const std::size_t robots_per_team =
      GENERATE(std::size_t{1}, std::size_t{6}, std::size_t{11}, std::size_t{16});
  CAPTURE(seed, robots_per_team);
  Rng rng(seed);
  const Field field{6, 4.5};
  const OscillatingRobots oscillating(field, robots_per_team, rng);
  constexpr double kStep_s = 1e-5;
  for (double t_s = 1000; t_s < 1005; t_s += 0.1) {
    const std::vector<SceneRobot> robots = oscillating.robots_at(t_s),
                                  later = oscillating.robots_at(t_s + kStep_s);
    REQUIRE(robots.size() == 2 * robots_per_team);
    std::set<std::pair<Team, std::uint32_t>> patterns;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      patterns.insert({robots[i].team, robots[i].pattern});
      CHECK(std::abs(robots[i].position_m.x()) < field.length_m / 2 - 0.09);
      CHECK(std::abs(robots[i].position_m.y()) < field.width_m / 2 - 0.09);
      CHECK(robots[i].velocity_mps.norm() < 2);
      const Vec2 moved_mps = (later[i].position_m - robots[i].position_m) / kStep_s;
      CHECK((moved_mps - robots[i].velocity_mps).norm() < 1e-3);
      CHECK(std::abs(later[i].heading_rad - robots[i].heading_rad - kStep_s * robots[i].angular_radps) <
            1e-9);
      CHECK((oscillating.ball_at(t_s).position_m.head<2>() - robots[i].position_m).norm() > 0.11);
      for (std::size_t j = 0; j < i; ++j) CHECK((robots[i].position_m - robots[j].position_m).norm() > 0.18);
    }
    CHECK(patterns.size() == robots.size());
  }
}

TEST_CASE("a field without space for the robots is rejected") {
  Rng rng(1);
  CHECK_THROWS_AS(OscillatingRobots({1, 1}, 11, rng), std::invalid_argument);
  CHECK_THROWS_AS(OscillatingRobots({60, 40}, 17, rng), std::invalid_argument);
}

}  // namespace sidestep::oscillating_robots_test
