// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/safety_search.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/map/random_map.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::safety_search_test {

const Time kStart = time_from_ns(5'000'000'000);
constexpr Duration kCycle{16'666'667};

Version moving_robot(RobotId id, Vec2 position, Vec2 velocity) {
  Trajectory trajectory(kStart - Duration{8'000'000}, {position, velocity});
  append_stop(trajectory, 5);
  return {id, 1, id + 100u, 0, trajectory};
}

/// Slow reference: compares candidates one by one with versions one by one.
SearchResult reference_search(const FloorRules& rules, const SearchQuery& query,
                              std::span<const Version> others, Rng& rng) {
  const Vec2& velocity = query.at_start.velocity_mps;
  const Vec2 desired = limit_acceleration(query.desired_mps2, velocity, rules.limits, query.hold_time);
  std::vector<Vec2> sampled{desired};
  for (int i = 0; i < SafetySearch::kSamples; ++i)
    sampled.push_back(limit_acceleration(sample_acceleration(velocity, rules.limits, rng), velocity,
                                         rules.limits, query.hold_time));
  std::ranges::stable_sort(sampled, {}, [&](const Vec2& a) { return (a - desired).squaredNorm(); });
  SearchResult result;
  std::vector<Vec2> chosen;
  for (const Vec2& a : sampled) {
    const auto is_close = [&](const Vec2& b) { return (a - b).norm() < SafetySearch::kSpread_mps2; };
    if (result.count == SearchResult::kMaxCandidates || std::ranges::any_of(chosen, is_close)) continue;
    const Trajectory trajectory =
        accelerate_then_stop(query.start, query.at_start, a, query.hold_time, rules.limits.deceleration_mps2);
    const auto is_conflicting = [&](const Version& other) {
      return !is_clear(trajectory, other.trajectory, rules.min_separation_m() + other.inflation_m);
    };
    if (check_workspace(trajectory, rules) != Validity::kValid || std::ranges::any_of(others, is_conflicting))
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

/// A dense scene in which about half of the searches succeed. Some robots start later, are at rest, are
/// inflated, or exceed the motion limits.
Scene random_scene(Rng& rng) {
  Scene scene;
  const Duration hold_time = kCycle * static_cast<std::int64_t>(1 + (rng.chance(0.3) ? rng.below(9) : 0));
  scene.query = {kStart,
                 {{0, 0}, rng.chance(0.1) ? Vec2(0, 0) : random_velocity(rng, 2, 3)},
                 5 * random_vector(rng, 1),
                 hold_time};
  const auto count = rng.below(12);
  for (RobotId id = 1; id <= count; ++id) {
    const Vec2 velocity = rng.chance(0.2) ? Vec2(0, 0) : random_vector(rng, 1.4);
    Version version = moving_robot(id, random_vector(rng, 0.9), velocity);
    if (rng.chance(0.3)) version.trajectory = random_trajectory(rng, kStart);
    if (rng.chance(0.1)) version.inflation_m = rng.uniform(0, 0.1);
    scene.others.push_back(version);
  }
  return scene;
}

TEST_CASE("without neighbours, the desired acceleration is the first candidate") {
  SafetySearch search({});
  Rng rng(1);
  TrajectoryIndex empty_index;
  const auto result = search.search({kStart, {{0, 0}, {1, 0}}, {2, 1}, kCycle}, empty_index, rng);
  REQUIRE(result.count == SearchResult::kMaxCandidates);
  CHECK(result.desired_is_clear);
  CHECK((result.candidates[0].phases()[0].acceleration_mps2 - Vec2(2, 1)).norm() < 1e-12);
}

TEST_CASE(
    "candidates are clear of all robots and within the limits, and are sorted by distance from the desired "
    "motion") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {6, 6};
  rules.obstacles = {Circle{{0.5, 0.5}, 0.1}, Circle{{-0.6, 0.2}, 0.15}, Box{{0.4, -0.7}, {0.6, -0.5}},
                     Segment{{-0.7, -0.6}, {-0.4, -0.8}}};
  SafetySearch search(rules);
  TrajectoryIndex index;
  std::size_t found = 0, blocked = 0;
  for (int scene = 0; scene < 3000; ++scene) {
    std::vector<Version> others;
    for (RobotId id = 1; id <= 6; ++id) {
      const Vec2 others_velocity = random_velocity(rng, 2, 3);
      others.push_back(moving_robot(id, random_vector(rng, 0.8), others_velocity));
    }
    index.assign(others);
    const Vec2 velocity = random_velocity(rng, 2, 3);
    const double y = rng.uniform(-1, 1), x = rng.uniform(-1, 1);
    const Vec2 desired = 5 * Vec2(x, y);
    const auto result = search.search({kStart, {{0, 0}, velocity}, desired, kCycle}, index, rng);
    ++(result.count ? found : blocked);
    const Vec2 reachable = limit_acceleration(desired, velocity, rules.limits, kCycle);
    double last = -1;
    for (std::size_t i = 0; i < result.count; ++i) {
      const Trajectory& candidate = result.candidates[i];
      REQUIRE(check_limits(candidate, rules.limits) == Validity::kValid);
      REQUIRE(check_workspace(candidate, rules) == Validity::kValid);
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

TEST_CASE("the search finds the same candidates as a slow reference, on every instruction set") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  FloorRules rules;
  rules.field = {2.2, 2.6};
  rules.obstacles = {Circle{{0.5, 0.5}, 0.1}, Circle{{-0.6, 0.2}, 0.15}, Box{{0.4, -0.7}, {0.6, -0.5}},
                     Segment{{-0.7, -0.6}, {-0.4, -0.8}}};
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(seed, kernels.name);
    SafetySearch search(rules, kernels);
    TrajectoryIndex index(kernels);
    Rng scenes(seed), rng(seed), slow_rng(seed);
    int found = 0, refused_desired = 0;
    for (int i = 0; i < 4000; ++i) {
      CAPTURE(i);
      const Scene scene = random_scene(scenes);
      index.assign(scene.others);
      const auto result = search.search(scene.query, index, rng);
      const auto expected = reference_search(rules, scene.query, scene.others, slow_rng);
      REQUIRE(result.count == expected.count);
      REQUIRE(result.desired_is_clear == expected.desired_is_clear);
      for (std::size_t k = 0; k < result.count; ++k) {
        const auto phases = result.candidates[k].phases(), expected_phases = expected.candidates[k].phases();
        REQUIRE(phases.size() == expected_phases.size());
        for (std::size_t p = 0; p < phases.size(); ++p) {
          REQUIRE(phases[p].duration == expected_phases[p].duration);
          REQUIRE(phases[p].acceleration_mps2 == expected_phases[p].acceleration_mps2);
        }
      }
      found += result.count > 0;
      refused_desired += !result.desired_is_clear;
    }
    CHECK(found > 1000);
    CHECK(refused_desired > 1000);
  }
}

TEST_CASE("near each border of the field, the search finds the same candidates as a slow reference") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  FloorRules rules;
  rules.field = {6, 4};
  SafetySearch search(rules);
  TrajectoryIndex empty_index;
  Rng scenes(seed), rng(seed), slow_rng(seed);
  std::array<int, 4> refused{};
  for (int i = 0; i < 4000; ++i) {
    CAPTURE(i);
    // The robot drives towards a border and can just stop before it.
    const std::size_t border = scenes.below(4);
    const Vec2 outwards = rotated({1, 0}, std::numbers::pi / 2 * static_cast<double>(border));
    const double half_m = (border % 2 == 0 ? rules.field.length_m : rules.field.width_m) / 2 - rules.radius_m;
    const double speed_mps = scenes.uniform(0, rules.limits.speed_mps);
    const double stop_m = speed_mps * speed_mps / (2 * rules.limits.deceleration_mps2);
    const Vec2 at_m = (half_m - stop_m - scenes.uniform(0, 0.1)) * outwards;
    const SearchQuery query{kStart, {at_m, speed_mps * outwards}, 3 * outwards, kCycle};
    const auto result = search.search(query, empty_index, rng);
    const auto expected = reference_search(rules, query, {}, slow_rng);
    REQUIRE(result.count == expected.count);
    REQUIRE(result.desired_is_clear == expected.desired_is_clear);
    refused[border] += !result.desired_is_clear;
  }
  for (const int count : refused) CHECK(count > 100);
}

TEST_CASE("among the blocked cells of a map, the search finds the same candidates as a slow reference") {
  const std::uint64_t seed = GENERATE(61u, 62u, 63u);
  CAPTURE(seed);
  Rng rng(seed);
  int found = 0, restricted = 0;
  for (int i = 0; i < 60; ++i) {
    FloorRules rules;
    MapGrid grid;
    grid.columns = grid.rows = 60, grid.resolution_m = 0.05, grid.origin_m = {-1.5, -1.5};
    BitGrid blocked = test::noise(rng, grid.columns, grid.rows, 0.04);
    for (int row = 26; row < 34; ++row) blocked.set_run(26, 34, row, false);  // around the robot
    rules.map = std::make_shared<const FloorMap>(OccupancyMap(grid, std::move(blocked)));
    SafetySearch search(rules);
    for (int k = 0; k < 20; ++k) {
      const Scene scene = random_scene(rng);
      TrajectoryIndex index;
      index.assign(scene.others);
      Rng first = rng, second = rng;
      const SearchResult result = search.search(scene.query, index, first);
      const SearchResult expected = reference_search(rules, scene.query, scene.others, second);
      CAPTURE(i, k);
      REQUIRE(result.count == expected.count);
      for (std::size_t n = 0; n < result.count; ++n)
        REQUIRE((result.candidates[n].rest_position_m() - expected.candidates[n].rest_position_m()).norm() <
                1e-12);
      found += result.count > 0 ? 1 : 0;
      FloorRules open = rules;
      open.map = nullptr;
      Rng third = rng;
      restricted += reference_search(open, scene.query, scene.others, third).count != expected.count ? 1 : 0;
      (void)rng.bits();
    }
  }
  CHECK(found > 100);
  CHECK(restricted > 100);
}

TEST_CASE("preferred accelerations that are safe come directly after the desired acceleration") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const FloorRules rules;
  SafetySearch search(rules);
  TrajectoryIndex others;
  const auto first_mps2 = [](const Trajectory& candidate) {
    return Vec2(candidate.phases().front().acceleration_mps2);
  };
  SearchQuery query{kStart, {{0, 0}, {0, 0}}, {2, 0}, kCycle};
  const std::array<Vec2, 3> preferred{{{0, rng.uniform(1, 2)}, {rng.uniform(-2, -1), 0}, {0, -1.5}}};
  query.preferred_mps2 = preferred;
  const SearchResult result = search.search(query, others, rng);
  REQUIRE(result.count >= 4);
  CHECK(result.desired_is_clear);
  CHECK((first_mps2(result.candidates[0]) - Vec2(2, 0)).norm() < 1e-9);
  for (std::size_t i = 0; i < preferred.size(); ++i)
    CHECK((first_mps2(result.candidates[i + 1]) - preferred[i]).norm() < 1e-9);
}

TEST_CASE("the same seed gives the same candidates") {
  SafetySearch one({}), two({});
  Rng rng_one(9), rng_two(9);
  TrajectoryIndex empty_index;
  for (int i = 0; i < 20; ++i) {
    const SearchQuery query{kStart, {{0, 0}, {0.1 * i, 0}}, {1, 1}, kCycle};
    const auto a = one.search(query, empty_index, rng_one), b = two.search(query, empty_index, rng_two);
    REQUIRE(a.count == b.count);
    for (std::size_t k = 0; k < a.count; ++k) {
      REQUIRE(a.candidates[k].phases()[0].acceleration_mps2 == b.candidates[k].phases()[0].acceleration_mps2);
    }
  }
}

TEST_CASE("every candidate is at rest before any moving obstacle could reach it") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {6, 6};
  SafetySearch search(rules);
  TrajectoryIndex empty_index;
  std::size_t found = 0, blocked = 0, refused = 0;
  for (int scene = 0; scene < 1000; ++scene) {
    std::vector<MovingObstacle> moving;
    for (int i = 0; i < 3; ++i) {
      moving.push_back({{rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5)},
                        0.09,
                        kStart - from_seconds(rng.uniform(0, 0.05)),
                        1.5});
    }
    const Vec2 velocity = random_velocity(rng, 2, 3);
    SearchQuery query{kStart, {{0, 0}, velocity}, 3 * rotated({1, 0}, rng.uniform(-3, 3)), kCycle};
    Rng again = rng;
    const std::size_t without = search.search(query, empty_index, again).count;
    query.moving = moving;
    const auto result = search.search(query, empty_index, rng);
    ++(result.count ? found : blocked);
    refused += result.count < without;
    for (std::size_t i = 0; i < result.count; ++i) {
      const Trajectory& candidate = result.candidates[i];
      // Checks by dense sampling.
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

TEST_CASE("every candidate is at rest before an unknown obstacle beyond the seen region could reach it") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {6, 6};
  SafetySearch search(rules);
  TrajectoryIndex empty_index;
  std::size_t found = 0, blocked = 0, refused = 0;
  for (int scene = 0; scene < 1000; ++scene) {
    const Vec2 velocity = random_velocity(rng, 2, 3);
    const double age_s = rng.uniform(0, 0.2), direction_rad = rng.uniform(-3, 3);
    SearchQuery query{kStart, {{0, 0}, velocity}, 3 * rotated({1, 0}, direction_rad), kCycle};
    Rng again = rng;
    const std::size_t without = search.search(query, empty_index, again).count;
    query.seen = {random_vector(rng, 0.2), rng.uniform(0.1, 2), kStart - from_seconds(age_s), 1.5};
    const auto result = search.search(query, empty_index, rng);
    ++(result.count ? found : blocked);
    refused += result.count < without;
    for (std::size_t i = 0; i < result.count; ++i) {
      const Trajectory& candidate = result.candidates[i];
      // Checks by dense sampling.
      for (Time t = candidate.start(); t < candidate.end(); t += Duration{500'000}) {
        const double distance = (candidate.state_at(t).position_m - query.seen.centre_m).norm();
        REQUIRE(distance + rules.radius_m + rules.margin_m < query.seen.radius_at_m(t));
      }
    }
  }
  CHECK(found > 100);
  CHECK(blocked > 100);
  CHECK(refused > 100);
}

TEST_CASE(
    "among hundreds of moving obstacles, all candidates are passively safe and no safe candidate is "
    "refused") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {20, 20};
  SafetySearch search(rules);
  TrajectoryIndex empty_index;
  int found = 0, restricted = 0;
  for (int scene = 0; scene < 300; ++scene) {
    std::vector<MovingObstacle> moving;
    for (int i = 0; i < 200; ++i) {
      const Vec2 position = random_vector(rng, 9);
      const double age_s = rng.uniform(-0.1, 0.3);
      moving.push_back({position, 0.09, kStart - from_seconds(age_s), 1.5});
    }
    SearchQuery query{kStart, {{0, 0}, random_velocity(rng, 2, 3)}, {3, 0}, kCycle};
    query.moving = moving;
    Rng again = rng;
    const auto result = search.search(query, empty_index, rng);
    query.moving = {};
    const auto all = search.search(query, empty_index, again);
    const auto is_safe = [&](const Trajectory& candidate) {
      return is_passively_safe_from_all(candidate, moving, rules.radius_m + rules.margin_m);
    };
    REQUIRE(std::all_of(result.candidates.begin(), result.candidates.begin() + result.count, is_safe));
    // If all candidates are safe, the search finds as many candidates as without obstacles.
    const bool is_restricted =
        !std::all_of(all.candidates.begin(), all.candidates.begin() + all.count, is_safe);
    if (!is_restricted) REQUIRE(result.count == all.count);
    found += result.count > 0;
    restricted += is_restricted;
  }
  CHECK(found > 30);
  CHECK(restricted > 30);
}

}  // namespace sidestep::safety_search_test
