// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/course.hpp"

#include <algorithm>

#include "common/motion/validity.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/joint/random_course.hpp"

namespace sidestep::course_test {

/// The shortest time for a distance, found by trying peak speeds in small steps.
double brute_force_time_s(double distance_m, const MotionLimits& limits) {
  double best_s = 1e9;
  constexpr int kSteps = 20'000;
  for (int i = 1; i <= kSteps; ++i) {
    const double v = limits.speed_mps * i / kSteps;
    const double ramps_m = v * v / 2 / limits.acceleration_mps2 + v * v / 2 / limits.deceleration_mps2;
    if (ramps_m > distance_m) break;
    best_s = std::min(
        best_s, v / limits.acceleration_mps2 + v / limits.deceleration_mps2 + (distance_m - ramps_m) / v);
  }
  return best_s;
}

TEST_CASE("a leg obeys the limits, takes the shortest time and ends exactly at its target") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    MotionLimits limits;
    limits.acceleration_mps2 = rng.uniform(0.5, 4);
    limits.deceleration_mps2 = rng.uniform(0.5, 6);
    limits.speed_mps = rng.uniform(0.3, 3);
    const double far_m = rng.chance(0.2) ? 1e-3 : 4;
    const Vec2 from = random_position(rng, far_m), to = random_position(rng, far_m);
    const double distance_m = (to - from).norm();
    const LegTimes times = leg_times(distance_m, limits);
    const Trajectory leg = make_leg(Time{} + from_seconds(2), from, to, times);
    CHECK(check_limits(leg, limits) == Validity::kValid);
    CHECK((leg.rest_position_m() - to).norm() < 1e-12);
    CHECK(leg.residual_speed_mps() < 1e-12);
    CHECK(leg.end() - leg.start() == times.total());
    const double slow_s = brute_force_time_s(distance_m, limits);
    CHECK(to_seconds(times.total()) <= slow_s + 4e-9);
    CHECK(to_seconds(times.total()) >= slow_s * (1 - 1e-3) - 4e-9);
  }
  CHECK(leg_times(0, MotionLimits{}).total() == Duration{0});
}

TEST_CASE("a clipped trajectory equals the whole one within its interval and rests afterwards") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Vec2 from = random_position(rng, 2), to = random_position(rng, 2);
    const Trajectory leg =
        make_leg(Time{} + from_seconds(1), from, to, leg_times((to - from).norm(), MotionLimits{}));
    const double begin_s = rng.uniform(1, 5), end_s = begin_s + rng.uniform(0, 2);
    const Time begin = Time{} + from_seconds(begin_s), end = Time{} + from_seconds(end_s);
    const Trajectory part = clipped(leg, begin, end);
    for (int i = 0; i < 50; ++i) {
      const Time t =
          begin +
          Duration{static_cast<std::int64_t>(rng.uniform() * static_cast<double>((end - begin).count()))};
      CHECK((part.state_at(t).position_m - leg.state_at(t).position_m).norm() < 1e-9);
    }
    CHECK((part.state_at(end + from_seconds(9)).position_m - leg.state_at(end).position_m).norm() < 1e-9);
  }
}

TEST_CASE("a course and a sampled check agree on whether a motion is clear of the course") {
  int clear = 0, blocked = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Course course = random_course(rng, static_cast<int>(rng.below(4)), 1);
    const Vec2 from = random_position(rng, 1), to = random_position(rng, 1);
    const Trajectory motion = make_leg(Time{} + from_seconds(rng.uniform(0, 3)), from, to,
                                       leg_times((to - from).norm(), MotionLimits{}));
    const bool for_ever = rng.chance(0.3);
    const Time until = motion.end() - from_seconds(rng.uniform(0, 0.2));
    const Time sampled_until = for_ever ? std::max(motion.end(), course.end()) : until;
    double nearest_m = 1e9;
    constexpr double kStep_s = 5e-4;
    for (Time t = motion.start(); t <= sampled_until; t += from_seconds(kStep_s))
      nearest_m = std::min(nearest_m, (motion.state_at(t).position_m - course.state_at(t).position_m).norm());
    constexpr double kSeparation_m = 0.3, kBetweenSamples_m = 4 * kStep_s;
    if (is_clear(course, motion, for_ever ? Time::max() : until, kSeparation_m)) {
      ++clear;
      CHECK(nearest_m >= kSeparation_m);
    } else {
      ++blocked;
      CHECK(nearest_m <= kSeparation_m + kBetweenSamples_m);
    }
  }
  CHECK(clear > 100);
  CHECK(blocked > 100);
}

}  // namespace sidestep::course_test
