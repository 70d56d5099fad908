// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/escape_search.hpp"

#include <algorithm>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::escape_search_test {

constexpr Time kStart = time_from_ns(2'000'000'000);
constexpr Duration kHoldTime{50'000'000};

FloorRules test_rules() {
  FloorRules rules;
  rules.field = {4, 4};
  rules.obstacles.push_back(Circle{{1, 1}, 0.3});
  return rules;
}

Version braking(RobotId robot, Vec2 position, Vec2 velocity) {
  Trajectory stop(kStart - kHoldTime, {position, velocity});
  append_stop(stop, 5);
  return {robot, 1, 100, 0, stop};
}

double sampled_distance_m(const Trajectory& a, const Trajectory& b) {
  double smallest = 1e9;
  for (Time t = kStart; t < kStart + std::chrono::seconds(2); t += std::chrono::milliseconds(1))
    smallest = std::min(smallest, (a.state_at(t).position_m - b.state_at(t).position_m).norm());
  return smallest;
}

SearchQuery query_on(const Version& base, Vec2 desired) {
  SearchQuery query;
  query.start = kStart;
  query.at_start = base.trajectory.state_at(kStart);
  query.desired_mps2 = desired;
  query.hold_time = kHoldTime;
  return query;
}

TrajectoryIndex index_of(std::span<const Version> versions) {
  TrajectoryIndex index;
  index.assign(versions);
  return index;
}

TEST_CASE("a base without conflicts has no escape candidates") {
  const Version base = braking(1, {0, 0}, {0.5, 0}), other = braking(2, {0.5, 0}, {0, 0});
  CHECK(search_escape(query_on(base, {3, 0}), base, index_of({&other, 1}), test_rules()).count == 0);
}

TEST_CASE("escape candidates lead away from the conflict, and the desired motion comes first if it does so") {
  const Version base = braking(1, {0, 0}, {0, 0}), other = braking(2, {0.15, 0}, {0, 0});
  const auto towards = search_escape(query_on(base, {3, 0}), base, index_of({&other, 1}), test_rules());
  REQUIRE(towards.count == SearchResult::kMaxCandidates);
  CHECK_FALSE(towards.desired_is_clear);
  CHECK(towards.candidates[0].rest_position_m().x() < -0.001);
  const auto away = search_escape(query_on(base, {-2, 0.5}), base, index_of({&other, 1}), test_rules());
  CHECK(away.desired_is_clear);
  CHECK(away.candidates[0].rest_position_m().y() > 0);
}

TEST_CASE("robots that were pushed too near to an obstacle or off the field find escape candidates") {
  for (const Vec2& position :
       {Vec2(1, 0.65), Vec2(0.7, 1.2), Vec2(1.98, 0), Vec2(-0.3, -2.1), Vec2(2.2, 2.2)}) {
    CAPTURE(position.x(), position.y());
    const Version base = braking(1, position, {0, 0});
    CHECK(search_escape(query_on(base, {0, 0}), base, TrajectoryIndex(), test_rules()).count > 0);
  }
}

TEST_CASE("every escape candidate rests before an opponent can touch the robot") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  const FloorRules rules = test_rules();
  int found = 0, excluded = 0;
  for (int i = 0; i < 2000; ++i) {
    CAPTURE(i);
    const auto direction = [&] { return rotated({1, 0}, rng.uniform(-3.14, 3.14)); };
    const Version base = braking(1, {-0.5, -0.5}, rng.uniform(0, 1) * direction());
    const Version other = braking(2, Vec2(-0.5, -0.5) + rng.uniform(0.1, 0.18) * direction(), {0, 0});
    SearchQuery query = query_on(base, 3 * direction());
    const int without_opponent =
        static_cast<int>(search_escape(query, base, index_of({&other, 1}), rules).count);
    const MovingObstacle opponent{query.at_start.position_m + rng.uniform(0.2, 0.8) * direction(), 0.09,
                                  kStart - from_seconds(rng.uniform(0, 0.2)), rng.uniform(0.2, 2)};
    query.moving = {&opponent, 1};
    const SearchResult result = search_escape(query, base, index_of({&other, 1}), rules);
    excluded += without_opponent - static_cast<int>(result.count);
    for (std::size_t k = 0; k < result.count; ++k) {
      ++found;
      const Trajectory& candidate = result.candidates[k];
      for (Time t = kStart; t < candidate.end(); t += std::chrono::milliseconds(2)) {
        const double distance_m = (candidate.state_at(t).position_m - opponent.position_m).norm();
        REQUIRE(distance_m > opponent.reach_m(t) + rules.radius_m + rules.margin_m);
      }
    }
  }
  CHECK(found > 500);
  CHECK(excluded > 500);
}

TEST_CASE(
    "every escape candidate rests before an unknown obstacle beyond the seen region can touch the robot") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  const FloorRules rules = test_rules();
  int found = 0, excluded = 0;
  for (int i = 0; i < 2000; ++i) {
    CAPTURE(i);
    const auto direction = [&] { return rotated({1, 0}, rng.uniform(-3.14, 3.14)); };
    const Version base = braking(1, {-0.5, -0.5}, rng.uniform(0, 1) * direction());
    const Version other = braking(2, Vec2(-0.5, -0.5) + rng.uniform(0.1, 0.18) * direction(), {0, 0});
    SearchQuery query = query_on(base, 3 * direction());
    const SearchResult without = search_escape(query, base, index_of({&other, 1}), rules);
    const double radius_m = rng.uniform(0.1, 1), age_s = rng.uniform(0, 0.2);
    query.seen = {query.at_start.position_m, radius_m, kStart - from_seconds(age_s), 1};
    const SearchResult result = search_escape(query, base, index_of({&other, 1}), rules);
    excluded += static_cast<int>(without.count) - static_cast<int>(result.count);
    for (std::size_t k = 0; k < result.count; ++k) {
      ++found;
      const Trajectory& candidate = result.candidates[k];
      for (Time t = kStart; t < candidate.end(); t += std::chrono::milliseconds(2)) {
        const double distance_m = (candidate.state_at(t).position_m - query.seen.centre_m).norm();
        REQUIRE(distance_m + rules.radius_m + rules.margin_m < query.seen.radius_at_m(t));
      }
    }
  }
  CHECK(found > 500);
  CHECK(excluded > 500);
}

TEST_CASE(
    "escape candidates come no nearer to other robots than the base does, or than the minimum separation") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);
  const FloorRules rules = test_rules();
  int found = 0;
  for (int i = 0; i < 400; ++i) {
    const auto random_vector = [&](double max_norm) {
      const double angle_rad = rng.uniform(0, 6.28);
      return rotated(Vec2(rng.uniform(0, max_norm), 0), angle_rad);
    };
    const auto random_braking = [&](RobotId robot, double max_m) {
      const Vec2 velocity = random_vector(1.5);
      return braking(robot, random_vector(max_m), velocity);
    };
    const Version base = random_braking(1, 0.5);
    std::vector<Version> others;
    for (RobotId robot = 2; robot < 6; ++robot) {
      others.push_back(random_braking(robot, 0.7));
      if (rng.chance(0.3)) others.back().inflation_m = 0.02;
    }
    const auto result = search_escape(query_on(base, random_vector(3)), base, index_of(others), rules);
    for (std::size_t k = 0; k < result.count; ++k) {
      ++found;
      for (const Version& other : others) {
        const double full_separation = rules.min_separation_m() + other.inflation_m;
        const double min_distance =
            std::min(full_separation, sampled_distance_m(base.trajectory, other.trajectory));
        CAPTURE(i, k, other.robot);
        // The base's closest approach may lie between two samples.
        REQUIRE(sampled_distance_m(result.candidates[k], other.trajectory) >= min_distance - 0.003);
      }
      REQUIRE(check_limits(result.candidates[k], rules.limits) == Validity::kValid);
    }
  }
  CHECK(found > 200);
}

}  // namespace sidestep::escape_search_test
