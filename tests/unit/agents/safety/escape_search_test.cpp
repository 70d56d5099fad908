// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/escape_search.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/random/rng.hpp"

using namespace sidestep;

namespace {

constexpr Time kStart = time_from_ns(2'000'000'000);
constexpr Duration kPhase{50'000'000};

FloorRules rules_here() {
  FloorRules rules;
  rules.field = {4, 4};
  rules.obstacles.push_back({{1, 1}, 0.3});
  return rules;
}

Version braking(RobotId robot, Vec2 place, Vec2 velocity, double inflation_m = 0) {
  Trajectory stop(kStart - kPhase, {place, velocity});
  append_stop(stop, 5);
  return {robot, 1, 100, 0, stop, inflation_m};
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
  query.phase = kPhase;
  query.inflation_m = base.inflation_m;
  return query;
}

TrajectoryIndex crowd_of(std::span<const Version> versions) {
  TrajectoryIndex crowd;
  crowd.assign(versions);
  return crowd;
}

}  // namespace

TEST_CASE("where the base is clear of everybody there is nothing to escape from") {
  const Version base = braking(1, {0, 0}, {0.5, 0}), other = braking(2, {0.5, 0}, {0, 0});
  CHECK(search_escape(query_on(base, {3, 0}), base, crowd_of({&other, 1}), rules_here()).count == 0);
}

TEST_CASE("ways out lead away from who is too near, and the wish comes first where it does too") {
  const Version base = braking(1, {0, 0}, {0, 0}), other = braking(2, {0.15, 0}, {0, 0});
  const auto towards = search_escape(query_on(base, {3, 0}), base, crowd_of({&other, 1}), rules_here());
  REQUIRE(towards.count == SearchResult::kMaxCandidates);
  CHECK_FALSE(towards.desired_is_clear);
  CHECK(towards.candidates[0].rest_position_m().x() < -0.001);
  const auto away = search_escape(query_on(base, {-2, 0.5}), base, crowd_of({&other, 1}), rules_here());
  CHECK(away.desired_is_clear);
  CHECK(away.candidates[0].rest_position_m().y() > 0);
}

TEST_CASE("robots that were pushed into an obstacle's room or off the field find a way out") {
  for (const Vec2& place : {Vec2(1, 0.65), Vec2(0.7, 1.2), Vec2(1.98, 0), Vec2(-0.3, -2.1), Vec2(2.2, 2.2)}) {
    CAPTURE(place.x(), place.y());
    const Version base = braking(1, place, {0, 0});
    CHECK(search_escape(query_on(base, {0, 0}), base, TrajectoryIndex(), rules_here()).count > 0);
  }
}

TEST_CASE("no way out comes nearer to anybody than the base does, or than it should") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);
  const FloorRules rules = rules_here();
  int found = 0;
  for (int i = 0; i < 400; ++i) {
    const auto drawn = [&](double most) {
      return rotated(Vec2(rng.uniform(0, most), 0), rng.uniform(0, 6.28));
    };
    const Version base = braking(1, drawn(0.5), drawn(1.5), rng.chance(0.3) ? 0.02 : 0);
    std::vector<Version> others;
    for (RobotId robot = 2; robot < 6; ++robot) others.push_back(braking(robot, drawn(0.7), drawn(1.5)));
    const auto result = search_escape(query_on(base, drawn(3)), base, crowd_of(others), rules);
    for (std::size_t k = 0; k < result.count; ++k) {
      ++found;
      for (const Version& other : others) {
        const double keep = rules.min_separation_m() + base.inflation_m + other.inflation_m;
        const double kept = std::min(keep, sampled_distance_m(base.trajectory, other.trajectory));
        CAPTURE(i, k, other.robot);
        // The base's nearest point may lie between two samples.
        REQUIRE(sampled_distance_m(result.candidates[k], other.trajectory) >= kept - 0.003);
      }
      REQUIRE(check_limits(result.candidates[k], rules.limits) == msg::REASON_GRANTED);
    }
  }
  CHECK(found > 200);
}
