// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/creep_search.hpp"

#include "agents/safety/creeping.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::creep_search_test {

constexpr double kSeparation_m = 0.104;
constexpr Duration kHold{16'666'667};
const Time kStart = time_from_ns(1'000'000'000);

SearchQuery query_at_rest(std::span<const MovingObstacle> strangers) {
  SearchQuery query{kStart, {}, {3, 0}, kHold};
  query.moving = strangers;
  query.creep_mps = kCreep_mps;
  return query;
}

MovingObstacle stranger_at(const Vec2& at_m) { return {at_m, 0.09, kStart - Duration{60'000'000}, 1.5}; }

TEST_CASE("a robot beside a stranger creeps straight away from the stranger first") {
  const std::vector<MovingObstacle> strangers{stranger_at({0.25, 0})};
  const std::vector<Vec2> away = accelerations_away(query_at_rest(strangers), kSeparation_m);
  REQUIRE(away.size() > 3);
  CHECK(away.front().x() < -1);
  CHECK(std::abs(away.front().y()) < 1e-9);
  for (const Vec2& acceleration : away) {
    CHECK(acceleration.x() < 0);
    CHECK(acceleration.norm() * to_seconds(kHold) < kCreep_mps);
  }
}

TEST_CASE("a robot between two strangers finds the few directions that lead away from both") {
  const std::vector<MovingObstacle> strangers{stranger_at({-0.19, -0.1}), stranger_at({0.27, 0.17})};
  const std::vector<Vec2> away = accelerations_away(query_at_rest(strangers), kSeparation_m);
  REQUIRE_FALSE(away.empty());
  for (const MovingObstacle& stranger : strangers) CHECK(away.front().dot(stranger.position_m) < 0);
}

TEST_CASE("a robot does not creep if it moves, if no stranger is near, or if strangers surround it") {
  const std::vector<MovingObstacle> near{stranger_at({0.25, 0})}, far{stranger_at({0.6, 0})};
  const std::vector<MovingObstacle> around{stranger_at({0.25, 0}), stranger_at({-0.13, 0.21}),
                                           stranger_at({-0.13, -0.21})};
  CHECK(accelerations_away(query_at_rest(far), kSeparation_m).empty());
  CHECK(accelerations_away(query_at_rest(around), kSeparation_m).empty());
  SearchQuery moving = query_at_rest(near);
  moving.at_start.velocity_mps = {0.04, 0};
  CHECK(accelerations_away(moving, kSeparation_m).empty());
  moving.at_start.velocity_mps = {0.02, 0};
  CHECK_FALSE(accelerations_away(moving, kSeparation_m).empty());
  moving.creep_mps = 0;
  CHECK(accelerations_away(moving, kSeparation_m).empty());
}

TEST_CASE("creeping leads away from every stranger within reach, and is safe by the rule for strangers") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<MovingObstacle> strangers;
    for (std::uint64_t count = 1 + rng.below(3); count > 0; --count)
      strangers.push_back(stranger_at(rotated({rng.uniform(0.2, 0.6), 0}, rng.uniform(-3.2, 3.2))));
    const SearchQuery query = query_at_rest(strangers);
    for (const Vec2& acceleration : accelerations_away(query, kSeparation_m)) {
      const Trajectory motion = accelerate_then_stop(kStart, query.at_start, acceleration, kHold, 5);
      CHECK(is_passively_safe_from_all(motion, strangers, kSeparation_m, kCreep_mps));
      CHECK(motion.rest_position_m().norm() < 0.001);
    }
  }
}

}  // namespace sidestep::creep_search_test
