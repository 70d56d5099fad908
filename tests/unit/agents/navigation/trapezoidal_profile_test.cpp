// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/trapezoidal_profile.hpp"

#include "common/motion/robot_model.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::trapezoidal_profile_test {

const MotionLimits kLimits;

TEST_CASE("a trapezoidal profile covers its distance and ends at rest within its limits") {
  Rng rng(2);
  for (int i = 0; i < 20'000; ++i) {
    const double distance = rng.uniform(-3, 3), velocity = rng.uniform(-2.5, 2.5);
    const TrapezoidalProfile profile(distance, velocity, kLimits);
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

TEST_CASE("two-dimensional motion control brings a robot to its goal from any initial velocity") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    State state{random_vector(rng, 2), random_velocity(rng, 2, 3.2)};
    const Duration cycle{16'666'667};
    const double dt = to_seconds(cycle);
    const Vec2 goal = random_vector(rng, 2);
    double seconds = 0;
    while ((state.position_m - goal).norm() > 0.002 || state.velocity_mps.norm() > 0.02) {
      const Vec2 v =
          TrapezoidalProfile2d(goal - state.position_m, state.velocity_mps, kLimits).velocity_after(dt);
      const Vec2 a = limit_acceleration((v - state.velocity_mps) / dt, state.velocity_mps, kLimits, cycle);
      state = state_after(state, a, dt);
      REQUIRE((seconds += dt) < 6);
    }
  }
}

}  // namespace sidestep::trapezoidal_profile_test
