// SPDX-License-Identifier: Apache-2.0
#include "common/motion/validity.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::validity_test {

const MotionLimits kLimits;

TEST_CASE("a trajectory beyond the limits, without a rest or outside the workspace is invalid") {
  FloorRules rules;
  rules.field = {4, 3};
  rules.obstacles = {Circle{{1, 0}, 0.1}};
  const Time t = time_from_ns(1'000'000'000);
  const auto stop_from = [&](Vec2 p, Vec2 v, Vec2 a, double seconds) {
    Trajectory trajectory(t, {p, v});
    trajectory.append(from_seconds(seconds), a);
    append_stop(trajectory, 5);
    return trajectory;
  };
  CHECK(check_limits(stop_from({0, 0}, {1, 0}, {3, 0}, 0.1), rules.limits) == Validity::kValid);
  CHECK(check_limits(stop_from({0, 0}, {1, 0}, {3.1, 0}, 0.1), rules.limits) == Validity::kBeyondLimits);
  CHECK(check_limits(stop_from({0, 0}, {1.9, 0}, {3, 0}, 0.1), rules.limits) == Validity::kBeyondLimits);
  CHECK(check_limits(stop_from({0, 0}, {0, 0}, {-5, 0}, 0.1), rules.limits) == Validity::kBeyondLimits);
  Trajectory rolling(t, {{0, 0}, {1, 0}});
  rolling.append(from_seconds(0.1), {0, 0});
  CHECK(check_limits(rolling, rules.limits) == Validity::kNotAtRest);

  CHECK(check_workspace(stop_from({0, 1}, {1, 0}, {0, 0}, 0.1), rules) == Validity::kValid);
  CHECK(check_workspace(stop_from({0, 0}, {2, 0}, {0, 0}, 0.3), rules) == Validity::kObstacle);
  CHECK(check_workspace(stop_from({0, 1.2}, {0, 2}, {0, 0}, 0.1), rules) == Validity::kOutsideField);
  // The robot leaves the field and returns within one phase.
  CHECK(check_workspace(stop_from({0, 1.3}, {0, 1}, {0, -3}, 0.66), rules) == Validity::kOutsideField);
}

TEST_CASE("a phase that brakes at D may not continue at D after the velocity has reversed") {
  const Time t = time_from_ns(1'000'000'000);
  const auto held_for = [&](Vec2 velocity, Vec2 acceleration, double seconds) {
    Trajectory trajectory(t, {{0, 0}, velocity});
    trajectory.append(from_seconds(seconds), acceleration);
    append_stop(trajectory, kLimits.deceleration_mps2);
    return check_limits(trajectory, kLimits);
  };
  CHECK(held_for({1, 0}, {-5, 0}, 0.19) == Validity::kValid);
  CHECK(held_for({1, 0}, {-5, 0}, 0.2) == Validity::kValid);
  CHECK(held_for({1, 0}, {-5, 0}, 0.201) == Validity::kBeyondLimits);
  CHECK(held_for({1, 0}, {-5, 0}, 0.4) == Validity::kBeyondLimits);
  CHECK(held_for({1, 0}, {-3, 0}, 0.4) == Validity::kValid);
  // The acceleration brakes at the start of the phase and is across the velocity at its end.
  CHECK(held_for({0.5, 0.1}, {-4.5, 0}, 0.05) == Validity::kValid);
  CHECK(held_for({0.5, 0.1}, {-4.5, 0}, 0.11) == Validity::kBeyondLimits);
  CHECK(held_for({0, 1}, {0, -4.9}, 0.21) == Validity::kBeyondLimits);
  // The second phase exceeds the limits.
  Trajectory later(t, {{0, 0}, {0.5, 0}});
  later.append(from_seconds(0.1), {3, 0});
  later.append(from_seconds(0.2), {-5, 0});
  append_stop(later, kLimits.deceleration_mps2);
  CHECK(check_limits(later, kLimits) == Validity::kBeyondLimits);
}

TEST_CASE("a continuation starts with the position and velocity of its base") {
  Rng rng(4);
  for (int i = 0; i < 1000; ++i) {
    const Trajectory base = random_trajectory(rng);
    const Time start = base.start() + from_seconds(rng.uniform(0.001, 1));
    const State expected = base.state_at(start);
    REQUIRE(continues(Trajectory(start, expected), base));
    REQUIRE_FALSE(
        continues(Trajectory(start, {expected.position_m + Vec2(1e-6, 0), expected.velocity_mps}), base));
    REQUIRE_FALSE(
        continues(Trajectory(start, {expected.position_m, expected.velocity_mps + Vec2(0, 1e-6)}), base));
    REQUIRE_FALSE(continues(Trajectory(base.start(), base.at_start()), base));
  }
}

TEST_CASE("a NaN violates the limits") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Time t = time_from_ns(1'000'000'000);
  Trajectory bad(t, {{0, 0}, {nan, 0}});
  CHECK(check_limits(bad, kLimits) != Validity::kValid);
}

}  // namespace sidestep::validity_test
