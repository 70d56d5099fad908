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
  const CreepAccelerations creeps = accelerations_away(query_at_rest(strangers), kSeparation_m);
  const std::span<const Vec2> away = creeps.all();
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
  const CreepAccelerations creeps = accelerations_away(query_at_rest(strangers), kSeparation_m);
  REQUIRE(creeps.count > 0);
  for (const MovingObstacle& stranger : strangers) CHECK(creeps.mps2[0].dot(stranger.position_m) < 0);
}

TEST_CASE("a robot does not creep if it moves, if no stranger is near, or if strangers surround it") {
  const std::vector<MovingObstacle> near{stranger_at({0.25, 0})}, far{stranger_at({0.6, 0})};
  const std::vector<MovingObstacle> around{stranger_at({0.25, 0}), stranger_at({-0.13, 0.21}),
                                           stranger_at({-0.13, -0.21})};
  CHECK(accelerations_away(query_at_rest(far), kSeparation_m).all().empty());
  CHECK(accelerations_away(query_at_rest(around), kSeparation_m).all().empty());
  SearchQuery moving = query_at_rest(near);
  moving.at_start.velocity_mps = {0.04, 0};
  CHECK(accelerations_away(moving, kSeparation_m).all().empty());
  moving.at_start.velocity_mps = {0.02, 0};
  CHECK_FALSE(accelerations_away(moving, kSeparation_m).all().empty());
  moving.creep_mps = 0;
  CHECK(accelerations_away(moving, kSeparation_m).all().empty());
}

TEST_CASE("creeping leads away from every stranger within reach, and is safe by the rule for strangers") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<MovingObstacle> strangers;
    for (std::uint64_t count = 1 + rng.below(3); count > 0; --count)
      strangers.push_back(stranger_at(rotated({rng.uniform(0.2, 0.6), 0}, rng.uniform(-3.2, 3.2))));
    const SearchQuery query = query_at_rest(strangers);
    const CreepAccelerations creeps = accelerations_away(query, kSeparation_m);
    for (const Vec2& acceleration : creeps.all()) {
      const Trajectory motion = accelerate_then_stop(kStart, query.at_start, acceleration, kHold, 5);
      CHECK(is_passively_safe_from_all(motion, strangers, kSeparation_m, kCreep_mps));
      CHECK(motion.rest_position_m().norm() < 0.001);
    }
  }
}

TEST_CASE("the first direction leads away from all strangers as directly as any") {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<MovingObstacle> strangers;
    const double middle_rad = rng.uniform(-3.2, 3.2), half_rad = rng.uniform(0.2, 1.7);
    for (std::uint64_t count = 1 + rng.below(500); count > 0; --count)
      strangers.push_back(
          stranger_at(rotated({rng.uniform(0.2, 0.25), 0}, middle_rad + rng.uniform(-half_rad, half_rad))));
    const auto least_cosine = [&](const Vec2& direction) {
      double least = 1;
      for (const MovingObstacle& stranger : strangers)
        least = std::min(least, direction.dot(-stranger.position_m.normalized()));
      return least;
    };
    double best = -1;
    for (int i = 0; i < 3600; ++i)
      best = std::max(best, least_cosine(rotated({1, 0}, i * 0.1 * 3.14159265 / 180)));
    const CreepAccelerations creeps = accelerations_away(query_at_rest(strangers), kSeparation_m);
    CAPTURE(best, creeps.count);
    if (creeps.count == 0) {
      CHECK(best < 0.001);
      continue;
    }
    ++found;
    CHECK(least_cosine(creeps.mps2[0].normalized()) > best - 0.002);
    CHECK(creeps.count <= CreepAccelerations::kMax);
  }
  CHECK(found > 100);
}

}  // namespace sidestep::creep_search_test
