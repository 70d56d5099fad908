// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/safety_search.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kStart = time_from_ns(5'000'000'000);
constexpr Duration kCycle{16'666'667};

Version moving_robot(RobotId id, Vec2 position, Vec2 velocity) {
  Trajectory trajectory(kStart - Duration{8'000'000}, {position, velocity});
  append_stop(trajectory, 5);
  return {id, 1, id + 100u, 0, trajectory};
}

/// The search as its description says it: one candidate after the other, one pair after the other.
SearchResult slow_search(const FloorRules& rules, const SearchSettings& settings, const SearchQuery& query,
                         std::span<const Version> others, Rng& rng) {
  const Vec2& velocity = query.at_start.velocity_mps;
  const Vec2 desired = limited(query.desired_mps2, velocity, rules.limits, query.phase);
  std::vector<Vec2> drawn{desired};
  for (int i = 0; i < settings.samples; ++i)
    drawn.push_back(limited(sample(velocity, rules.limits, rng), velocity, rules.limits, query.phase));
  std::ranges::stable_sort(drawn, {}, [&](const Vec2& a) { return (a - desired).squaredNorm(); });
  SearchResult result;
  std::vector<Vec2> chosen;
  for (const Vec2& a : drawn) {
    const auto is_close = [&](const Vec2& b) { return (a - b).norm() < settings.spread_mps2; };
    if (result.count == SearchResult::kMaxCandidates || std::ranges::any_of(chosen, is_close)) continue;
    const Trajectory trajectory =
        accelerate_then_stop(query.start, query.at_start, a, query.phase, rules.limits.deceleration_mps2);
    const auto is_in_the_way = [&](const Version& other) {
      return !is_clear(trajectory, other.trajectory, rules.min_separation_m() + query.inflation_m + other.inflation_m);
    };
    if (check_place(trajectory, rules) != msg::REASON_GRANTED || std::ranges::any_of(others, is_in_the_way))
      continue;
    result.desired_is_clear = result.desired_is_clear || a == desired;
    chosen.push_back(a);
    result.candidates[result.count++] = trajectory;
  }
  return result;
}

struct Scene {
  SearchQuery query;
  std::vector<Version> others;
};

/// A crowd in which about half the searches find something; some of the others start later, stand, are
/// larger than usual or move as no agent of ours would let them.
Scene random_scene(Rng& rng) {
  Scene scene;
  const Duration phase = kCycle * static_cast<std::int64_t>(1 + (rng.chance(0.3) ? rng.below(9) : 0));
  scene.query = {
      kStart,
      {{0, 0}, rng.chance(0.1) ? Vec2(0, 0) : Vec2(rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3, 3)))},
      5 * random_vector(rng, 1),
      phase};
  const auto count = rng.below(12);
  for (RobotId id = 1; id <= count; ++id) {
    Version version =
        moving_robot(id, random_vector(rng, 0.9), rng.chance(0.2) ? Vec2(0, 0) : random_vector(rng, 1.4));
    if (rng.chance(0.3)) version.trajectory = random_trajectory(rng, kStart);
    if (rng.chance(0.1)) version.inflation_m = rng.uniform(0, 0.1);
    scene.others.push_back(version);
  }
  return scene;
}

}  // namespace

TEST_CASE("with nobody near, the wish itself is the first candidate") {
  SafetySearch search({}, {});
  Rng rng(1);
  TrajectoryIndex nobody;
  const auto result = search.search({kStart, {{0, 0}, {1, 0}}, {2, 1}, kCycle}, nobody, rng);
  REQUIRE(result.count == SearchResult::kMaxCandidates);
  CHECK(result.desired_is_clear);
  CHECK((result.candidates[0].phases()[0].acceleration_mps2 - Vec2(2, 1)).norm() < 1e-12);
}

TEST_CASE(
    "every candidate is clear of everybody, within the limits, and the nearest to the wish comes first") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {6, 6};
  rules.obstacles = {{{0.5, 0.5}, 0.1}, {{-0.6, 0.2}, 0.15}};
  SafetySearch search(rules, {});
  TrajectoryIndex crowd;
  std::size_t found = 0, blocked = 0;
  for (int scene = 0; scene < 3000; ++scene) {
    std::vector<Version> others;
    for (RobotId id = 1; id <= 6; ++id) {
      others.push_back(moving_robot(id, {rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8)},
                                    rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3, 3))));
    }
    crowd.assign(others);
    const Vec2 velocity = rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3, 3));
    const Vec2 desired = 5 * Vec2(rng.uniform(-1, 1), rng.uniform(-1, 1));
    const auto result = search.search({kStart, {{0, 0}, velocity}, desired, kCycle}, crowd, rng);
    ++(result.count ? found : blocked);
    const Vec2 reachable = limited(desired, velocity, rules.limits, kCycle);
    double last = -1;
    for (std::size_t i = 0; i < result.count; ++i) {
      const Trajectory& candidate = result.candidates[i];
      REQUIRE(check_limits(candidate, rules.limits) == msg::REASON_GRANTED);
      REQUIRE(check_place(candidate, rules) == msg::REASON_GRANTED);
      for (const Version& other : others)
        REQUIRE(clearance_m(candidate, other.trajectory, rules.min_separation_m()) >= 0);
      const double distance = (candidate.phases()[0].acceleration_mps2 - reachable).norm();
      REQUIRE(distance >= last);
      last = distance;
    }
  }
  CHECK(found > 500);
  CHECK(blocked > 100);
}

TEST_CASE("the search finds exactly what a slow one finds, on every instruction set") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  FloorRules rules;
  rules.field = {2.2, 2.6};
  rules.obstacles = {{{0.5, 0.5}, 0.1}, {{-0.6, 0.2}, 0.15}};
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(seed, kernels.name);
    SafetySearch search(rules, {}, kernels);
    TrajectoryIndex crowd(kernels);
    Rng scenes(seed), rng(seed), slow_rng(seed);
    int found = 0, refused_wishes = 0;
    for (int i = 0; i < 4000; ++i) {
      CAPTURE(i);
      const Scene scene = random_scene(scenes);
      crowd.assign(scene.others);
      const auto result = search.search(scene.query, crowd, rng);
      const auto expected = slow_search(rules, {}, scene.query, scene.others, slow_rng);
      REQUIRE(result.count == expected.count);
      REQUIRE(result.desired_is_clear == expected.desired_is_clear);
      for (std::size_t k = 0; k < result.count; ++k) {
        const auto phases = result.candidates[k].phases(), wanted = expected.candidates[k].phases();
        REQUIRE(phases.size() == wanted.size());
        for (std::size_t p = 0; p < phases.size(); ++p) {
          REQUIRE(phases[p].duration == wanted[p].duration);
          REQUIRE(phases[p].acceleration_mps2 == wanted[p].acceleration_mps2);
        }
      }
      found += result.count > 0;
      refused_wishes += !result.desired_is_clear;
    }
    CHECK(found > 1000);
    CHECK(refused_wishes > 1000);
  }
}

TEST_CASE("the same seed gives the same candidates") {
  SafetySearch one({}, {}), two({}, {});
  Rng rng_one(9), rng_two(9);
  TrajectoryIndex nobody;
  for (int i = 0; i < 20; ++i) {
    const SearchQuery query{kStart, {{0, 0}, {0.1 * i, 0}}, {1, 1}, kCycle};
    const auto a = one.search(query, nobody, rng_one), b = two.search(query, nobody, rng_two);
    REQUIRE(a.count == b.count);
    for (std::size_t k = 0; k < a.count; ++k) {
      REQUIRE(a.candidates[k].phases()[0].acceleration_mps2 == b.candidates[k].phases()[0].acceleration_mps2);
    }
  }
}

TEST_CASE("whatever moves without asking, every candidate is at rest before it could be there") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {6, 6};
  SafetySearch search(rules, {});
  TrajectoryIndex nobody;
  std::size_t found = 0, blocked = 0, refused = 0;
  for (int scene = 0; scene < 1000; ++scene) {
    std::vector<MovingObstacle> moving;
    for (int i = 0; i < 3; ++i) {
      moving.push_back({{rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5)},
                        0.09,
                        kStart - from_seconds(rng.uniform(0, 0.05)),
                        1.5});
    }
    const Vec2 velocity = rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3, 3));
    SearchQuery query{kStart, {{0, 0}, velocity}, 3 * rotated({1, 0}, rng.uniform(-3, 3)), kCycle};
    Rng again = rng;
    const std::size_t without = search.search(query, nobody, again).count;
    query.moving = moving;
    const auto result = search.search(query, nobody, rng);
    ++(result.count ? found : blocked);
    refused += result.count < without;
    for (std::size_t i = 0; i < result.count; ++i) {
      const Trajectory& candidate = result.candidates[i];
      // By dense sampling.
      for (const MovingObstacle& obstacle : moving) {
        for (Time t = candidate.start(); t < candidate.end(); t += Duration{500'000}) {
          const double distance = (candidate.state_at(t).position_m - obstacle.position_m).norm();
          REQUIRE(distance > rules.radius_m + rules.margin_m + obstacle.reach_m(t));
        }
      }
    }
  }
  CHECK(found > 100);
  CHECK(blocked > 100);
  CHECK(refused > 100);
}
