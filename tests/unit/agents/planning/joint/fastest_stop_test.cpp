// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/fastest_stop.hpp"

#include <numbers>

#include "agents/planning/joint/leg.hpp"
#include "common/motion/validity.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/joint/random_course.hpp"

namespace sidestep::fastest_stop_test {

const MotionLimits kLimits;

/// A robot that stops as fast as it can, and then drives straight to the goal.
double stop_first_s(const State& from, const Vec2& goal_m) {
  Trajectory stop(Time{}, from);
  append_stop(stop, kLimits.deceleration_mps2);
  const double rest_m = (goal_m - stop.rest_position_m()).norm();
  return to_seconds(stop.end() - Time{}) + to_seconds(leg_times(rest_m, kLimits).total());
}

TEST_CASE("the fastest stop of a moving robot obeys the limits and ends at rest at the goal") {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Vec2 goal_m = random_position(rng, 2), position_m = random_position(rng, 2);
    const double angle_rad = rng.uniform(0, 2 * std::numbers::pi), speed_mps = rng.uniform(0.01, 2);
    const State from{position_m, rotated(Vec2(speed_mps, 0), angle_rad)};
    const Trajectory motion = fastest_stop(Time{} + from_seconds(3), from, goal_m, kLimits);
    CHECK(check_limits(motion, kLimits) == Validity::kValid);
    CHECK(motion.start() == Time{} + from_seconds(3));
    CHECK((motion.at_start().velocity_mps - from.velocity_mps).norm() == 0);
    CHECK((motion.rest_position_m() - goal_m).norm() < 1e-7);
    CHECK(to_seconds(motion.end() - motion.start()) <= stop_first_s(from, goal_m) + 1e-6);
    CHECK(longest_stop_s(from, goal_m, kLimits) == Approx(stop_first_s(from, goal_m)).margin(1e-6));
  }
}

TEST_CASE("a robot at rest, or on its way to the goal, takes the shortest time") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Vec2 start_m = random_position(rng, 2), goal_m = random_position(rng, 2);
    const Duration shortest = leg_times((goal_m - start_m).norm(), kLimits).total();
    const Trajectory from_rest = fastest_stop(Time{}, {start_m, {0, 0}}, goal_m, kLimits);
    CHECK(to_seconds(from_rest.end() - Time{}) == Approx(to_seconds(shortest)).margin(1e-7));
    const Time later = Time{} + shortest / 2;
    const Trajectory under_way = fastest_stop(later, from_rest.state_at(later), goal_m, kLimits);
    CHECK(to_seconds(under_way.end() - Time{}) == Approx(to_seconds(shortest)).margin(1e-3));
  }
}

TEST_CASE("a robot that is already at its goal has arrived") {
  CHECK(fastest_stop(Time{}, {{1, 2}, {0, 0}}, {1, 2}, kLimits).end() == Time{});
}

TEST_CASE("a robot that is too fast to stop at its goal comes back to it") {
  const Trajectory motion = fastest_stop(Time{}, {{0, 0}, {2, 0}}, {0.3, 0}, kLimits);
  CHECK(check_limits(motion, kLimits) == Validity::kValid);
  CHECK((motion.rest_position_m() - Vec2(0.3, 0)).norm() < 1e-7);
  CHECK(motion.end() > Time{} + from_seconds(0.4));
}

}  // namespace sidestep::fastest_stop_test
