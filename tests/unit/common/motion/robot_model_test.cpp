// SPDX-License-Identifier: Apache-2.0
#include "common/motion/robot_model.hpp"

#include <catch2/catch.hpp>

#include "agents/navigation/trapezoid.hpp"
#include "common/motion/validity.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {
const MotionLimits kLimits;
}

TEST_CASE("A(v) reaches F ahead and sideways and D behind") {
  const Vec2 v(1, 0);
  CHECK(is_admissible({3, 0}, v, kLimits));
  CHECK_FALSE(is_admissible({3.01, 0}, v, kLimits));
  CHECK(is_admissible({0, -3}, v, kLimits));
  CHECK_FALSE(is_admissible({0, 3.01}, v, kLimits));
  CHECK(is_admissible({-5, 0}, v, kLimits));
  CHECK_FALSE(is_admissible({-5.01, 0}, v, kLimits));
  CHECK_FALSE(is_admissible({-4.5, 2}, v, kLimits));
  CHECK_FALSE(is_admissible({-3.01, 0}, {0, 0}, kLimits));
}

TEST_CASE("samples lie in A(v), fill it, and keep to the speed limit once limited") {
  Rng rng(1);
  const Duration cycle{16'666'667};
  double furthest_behind = 0, furthest_ahead = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Vec2 v = rng.uniform(0, kLimits.speed_mps) * rotated({1, 0}, rng.uniform(-3.2, 3.2));
    const Vec2 a = sample(v, kLimits, rng);
    REQUIRE(is_admissible(a, v, kLimits));
    furthest_ahead = std::max(furthest_ahead, a.dot(v.normalized()));
    furthest_behind = std::min(furthest_behind, a.dot(v.normalized()));
    const Vec2 b = limited(random_vector(rng, 20), v, kLimits, cycle);
    REQUIRE(is_admissible(b, v, kLimits));
    REQUIRE((v + to_seconds(cycle) * b).norm() <= kLimits.speed_mps + 1e-9);
  }
  CHECK(furthest_ahead > 2.95);
  CHECK(furthest_behind < -4.9);
}

TEST_CASE("a trapezoid ends at its distance, at rest, within its limits") {
  Rng rng(2);
  for (int i = 0; i < 20'000; ++i) {
    const double distance = rng.uniform(-3, 3), velocity = rng.uniform(-2.5, 2.5);
    const Trapezoid profile(distance, velocity, kLimits);
    const int steps = 400;
    const double dt = profile.duration_s() / steps;
    double x = 0, before = velocity;
    for (int k = 0; k < steps; ++k) {
      const double v = profile.velocity_after((k + 1) * dt);
      x += 0.5 * (before + v) * dt;
      REQUIRE(std::abs(v) <= std::max(std::abs(velocity), kLimits.speed_mps) + 1e-9);
      before = v;
    }
    CAPTURE(i, distance, velocity);
    REQUIRE(x == Approx(distance).margin(0.01));
    REQUIRE(profile.velocity_after(profile.duration_s() + 1) == 0);
  }
}

TEST_CASE("two-dimensional motion control arrives from any velocity") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    State state{random_vector(rng, 2), rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3.2, 3.2))};
    const Duration cycle{16'666'667};
    const double dt = to_seconds(cycle);
    const Vec2 goal = random_vector(rng, 2);
    double seconds = 0;
    while ((state.position_m - goal).norm() > 0.002 || state.velocity_mps.norm() > 0.02) {
      const Vec2 v = Trapezoid2d(goal - state.position_m, state.velocity_mps, kLimits).velocity_after(dt);
      const Vec2 a = limited((v - state.velocity_mps) / dt, state.velocity_mps, kLimits, cycle);
      state = state_after(state, a, dt);
      REQUIRE((seconds += dt) < 6);
    }
  }
}

TEST_CASE("limits, rest and place of a trajectory are judged") {
  FloorRules rules;
  rules.field = {4, 3};
  rules.obstacles = {{{1, 0}, 0.1}};
  const Time t = time_from_ns(1'000'000'000);
  const auto stop_from = [&](Vec2 p, Vec2 v, Vec2 a, double seconds) {
    Trajectory trajectory(t, {p, v});
    trajectory.append(from_seconds(seconds), a);
    append_stop(trajectory, 5);
    return trajectory;
  };
  CHECK(check_limits(stop_from({0, 0}, {1, 0}, {3, 0}, 0.1), rules.limits) == msg::REASON_GRANTED);
  CHECK(check_limits(stop_from({0, 0}, {1, 0}, {3.1, 0}, 0.1), rules.limits) == msg::REASON_BEYOND_LIMITS);
  CHECK(check_limits(stop_from({0, 0}, {1.9, 0}, {3, 0}, 0.1), rules.limits) == msg::REASON_BEYOND_LIMITS);
  CHECK(check_limits(stop_from({0, 0}, {0, 0}, {-5, 0}, 0.1), rules.limits) == msg::REASON_BEYOND_LIMITS);
  Trajectory rolling(t, {{0, 0}, {1, 0}});
  rolling.append(from_seconds(0.1), {0, 0});
  CHECK(check_limits(rolling, rules.limits) == msg::REASON_NOT_AT_REST);

  CHECK(check_place(stop_from({0, 1}, {1, 0}, {0, 0}, 0.1), rules) == msg::REASON_GRANTED);
  CHECK(check_place(stop_from({0, 0}, {2, 0}, {0, 0}, 0.3), rules) == msg::REASON_OBSTACLE);
  CHECK(check_place(stop_from({0, 1.2}, {0, 2}, {0, 0}, 0.1), rules) == msg::REASON_OUTSIDE_FIELD);
  // Leaves the field and comes back within one phase: both ends are inside.
  CHECK(check_place(stop_from({0, 1.3}, {0, 1}, {0, -3}, 0.66), rules) == msg::REASON_OUTSIDE_FIELD);
}

TEST_CASE("a continuation starts where and as fast as its base is") {
  Rng rng(4);
  for (int i = 0; i < 1000; ++i) {
    const Trajectory base = random_trajectory(rng);
    const Time start = base.start() + from_seconds(rng.uniform(0.001, 1));
    const State there = base.state_at(start);
    REQUIRE(continues(Trajectory(start, there), base));
    REQUIRE_FALSE(continues(Trajectory(start, {there.position_m + Vec2(1e-6, 0), there.velocity_mps}), base));
    REQUIRE_FALSE(continues(Trajectory(start, {there.position_m, there.velocity_mps + Vec2(0, 1e-6)}), base));
    REQUIRE_FALSE(continues(Trajectory(base.start(), base.at_start()), base));
  }
}

TEST_CASE("a NaN is never within limits or on the field") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Time t = time_from_ns(1'000'000'000);
  Trajectory bad(t, {{0, 0}, {nan, 0}});
  CHECK(check_limits(bad, kLimits) != msg::REASON_GRANTED);
}
