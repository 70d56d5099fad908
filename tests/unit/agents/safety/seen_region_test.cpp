// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/seen_region.hpp"

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::seen_region_test {

const Time kBegin = time_from_ns(1'000'000'000);

/// Slow reference: the smallest distance of the robot's centre from the edge of the region until the robot
/// rests, by dense sampling.
double sampled_separation_m(const Trajectory& trajectory, const SeenRegion& seen) {
  const double seconds = to_seconds(trajectory.end() - trajectory.start());
  constexpr int kSamples = 2000;
  double min_separation = 1e9;
  for (int i = 0; i <= kSamples; ++i) {
    const Time t =
        i == kSamples ? trajectory.end() : trajectory.start() + from_seconds(seconds * i / kSamples);
    const Vec2 position = i == kSamples ? trajectory.rest_position_m() : trajectory.state_at(t).position_m;
    min_separation = std::min(min_separation, seen.radius_at_m(t) - (position - seen.centre_m).norm());
  }
  return min_separation;
}

SeenRegion random_region(Rng& rng) {
  const Vec2 centre = random_vector(rng, 1);
  const double radius_m = rng.uniform(0, 5), observed_s = rng.uniform(-1, 0.6);
  return {centre, radius_m, kBegin + from_seconds(observed_s), rng.chance(0.2) ? 0 : rng.uniform(0, 2)};
}

TEST_CASE("the seen region check never passes too near to the edge, and rarely fails elsewhere") {
  const std::uint64_t seed = GENERATE(range(1u, 25u));
  CAPTURE(seed);
  Rng rng(seed);
  int safe = 0, unsafe = 0, needlessly_unsafe = 0;
  for (int i = 0; i < 1500; ++i) {
    const Trajectory trajectory = random_trajectory(rng, kBegin);
    if (trajectory.end() == trajectory.start()) continue;  // at rest from the start
    const SeenRegion seen = random_region(rng);
    const double separation = rng.uniform(0, 0.5);
    const double true_separation = sampled_separation_m(trajectory, seen);
    const bool is_safe = is_passively_safe_from_unseen(trajectory, seen, separation);
    CAPTURE(i, true_separation, separation);
    if (is_safe) REQUIRE(separation <= true_separation);
    ++(is_safe ? safe : unsafe);
    needlessly_unsafe += !is_safe && separation < true_separation - 0.1;
  }
  CHECK(safe > 100);
  CHECK(unsafe > 100);
  CHECK(needlessly_unsafe < safe / 10);
}

TEST_CASE("a robot is safe only if it rests before an obstacle just beyond the edge could reach it") {
  // Braking at 5 m/s² from 1 m/s takes 0.2 s and 0.1 m. Meanwhile an obstacle approaches by 0.4 m at 2 m/s.
  Trajectory braking(kBegin, {{0, 0}, {1, 0}});
  append_stop(braking, 5);
  const double separation = 0.1;
  SeenRegion seen{{0, 0}, 0.1 + 0.4 + separation + 1e-6, kBegin, 2};
  CHECK(is_passively_safe_from_unseen(braking, seen, separation));
  seen.radius_m -= 2e-6;
  CHECK_FALSE(is_passively_safe_from_unseen(braking, seen, separation));
  seen.radius_m += 2e-6;
  seen.observed_at -= from_seconds(0.01);
  CHECK_FALSE(is_passively_safe_from_unseen(braking, seen, separation));
  seen.radius_m += 0.02;
  CHECK(is_passively_safe_from_unseen(braking, seen, separation));
  // The distance to the region's edge matters, not where in the region the robot was seen.
  seen.centre_m.x() -= 0.01;
  CHECK_FALSE(is_passively_safe_from_unseen(braking, seen, separation));
}

TEST_CASE("a robot at rest needs no seen region, and a moving robot needs none if all obstacles are known") {
  const SeenRegion nothing{{0, 0}, 0, kBegin, 2};
  CHECK(is_passively_safe_from_unseen(Trajectory::resting(kBegin, {0, 0}), nothing, 0.1));
  Trajectory leaving(kBegin, {{0, 0}, {0, 0}});
  leaving.append(from_seconds(0.1), {-3, 0});
  append_stop(leaving, 5);
  CHECK_FALSE(is_passively_safe_from_unseen(leaving, nothing, 0.1));
  CHECK(is_passively_safe_from_unseen(leaving, {}, 0.1));
}

TEST_CASE("a region does not shrink if obstacles do not move") {
  const SeenRegion seen{{0, 0}, 1, kBegin, 0};
  CHECK(seen.radius_at_m(kBegin + from_seconds(100)) == 1);
  Trajectory braking(kBegin + from_seconds(100), {{0.7, 0}, {1, 0}});
  append_stop(braking, 5);
  CHECK(is_passively_safe_from_unseen(braking, seen, 0.1));
  CHECK_FALSE(is_passively_safe_from_unseen(braking, seen, 0.25));
}

TEST_CASE("a region limited by another region is contained in both regions at all times") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 3000; ++i) {
    SeenRegion a = random_region(rng), b = random_region(rng);
    b.speed_mps = a.speed_mps;
    const SeenRegion both = a.limited_by(b);
    const Time t = std::max(a.observed_at, b.observed_at) + from_seconds(rng.uniform(0, 1));
    REQUIRE(both.radius_at_m(t) <= a.radius_at_m(t));
    REQUIRE(both.radius_at_m(t) + (both.centre_m - b.centre_m).norm() <= b.radius_at_m(t) + 1e-9);
  }
  const SeenRegion small{{1, 1}, 0.5, kBegin, 1};
  CHECK(SeenRegion{}.limited_by(small).radius_m == 0.5);
  CHECK(small.limited_by({}).radius_m == 0.5);
}

}  // namespace sidestep::seen_region_test
