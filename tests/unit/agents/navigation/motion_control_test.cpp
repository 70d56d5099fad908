// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_control.hpp"

#include <algorithm>
#include <cmath>

#include "common/motion/robot_model.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::motion_control_test {

TEST_CASE("a robot comes to rest at its goal for any control cycle and motor strength") {
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    MotionLimits limits;
    limits.speed_mps = rng.uniform(0.1, 4);
    limits.acceleration_mps2 = rng.uniform(0.3, 20);
    limits.deceleration_mps2 = rng.uniform(0.3, 20);
    const Duration cycle = from_seconds(1 / rng.uniform(4, 120));
    const Duration max_hold = cycle * (1 + static_cast<int>(rng.uniform(0, 3)));
    const Vec2 goal_m(rng.uniform(-2, 2), rng.uniform(-2, 2));
    State state;
    // More than twice the time that the distance takes at the speed limit, to allow for accelerating and
    // braking.
    const double limit_s = 20 + 2 * goal_m.norm() / limits.speed_mps;
    double elapsed_s = 0;
    for (; elapsed_s < limit_s; elapsed_s += to_seconds(cycle)) {
      const auto desired =
          desired_acceleration(goal_m - state.position_m, state.velocity_mps, limits, cycle, max_hold);
      REQUIRE(desired.hold >= cycle);
      REQUIRE(desired.hold <= max_hold);
      const Vec2 held =
          limit_acceleration(desired.acceleration_mps2, state.velocity_mps, limits, desired.hold);
      state = state_after(state, held, to_seconds(cycle));
    }
    CAPTURE(i, limits.speed_mps, limits.acceleration_mps2, limits.deceleration_mps2, to_seconds(cycle),
            to_seconds(max_hold), (goal_m - state.position_m).norm());
    CHECK((goal_m - state.position_m).norm() < 1e-3);
    CHECK(state.velocity_mps.norm() < 0.01);
  }
}

TEST_CASE(
    "a robot that brakes much harder than it accelerates hardly overshoots its goal for any control cycle") {
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    MotionLimits limits;
    limits.speed_mps = rng.uniform(1, 5);
    limits.acceleration_mps2 = rng.uniform(0.3, 3);
    limits.deceleration_mps2 = limits.acceleration_mps2 * rng.uniform(3, 30);
    const Duration cycle = from_seconds(1 / rng.uniform(5, 60));
    const Vec2 goal_m = rng.uniform(1, 10) * Vec2(0.6, 0.8);
    State state;
    double farthest_m = 0;
    for (double t_s = 0; t_s < 20; t_s += to_seconds(cycle)) {
      const auto desired =
          desired_acceleration(goal_m - state.position_m, state.velocity_mps, limits, cycle, cycle);
      const Vec2 held =
          limit_acceleration(desired.acceleration_mps2, state.velocity_mps, limits, desired.hold);
      state = state_after(state, held, to_seconds(cycle));
      farthest_m = std::max(farthest_m, state.position_m.norm());
    }
    CAPTURE(i, limits.speed_mps, limits.acceleration_mps2, limits.deceleration_mps2, to_seconds(cycle));
    // The robot brakes for a whole cycle, even if a shorter time would suffice.
    CHECK(farthest_m - goal_m.norm() < 0.5 * limits.speed_mps * to_seconds(cycle));
  }
}

TEST_CASE("braking after one hold never overshoots the goal, and covers half of a short distance") {
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    MotionLimits limits;
    limits.speed_mps = 10;
    limits.acceleration_mps2 = rng.uniform(0.3, 20);
    limits.deceleration_mps2 = rng.uniform(0.3, 20);
    const Duration hold = from_seconds(rng.uniform(0.01, 0.5));
    const Vec2 to_goal_m(rng.uniform(0, 0.1), rng.uniform(0, 0.1));
    const auto desired = desired_acceleration(to_goal_m, {0, 0}, limits, hold, hold);
    const Vec2 velocity = to_seconds(hold) * desired.acceleration_mps2;
    const Vec2 end_m =
        0.5 * to_seconds(hold) * velocity + velocity * (velocity.norm() / (2 * limits.deceleration_mps2));
    CAPTURE(to_seconds(hold), limits.acceleration_mps2, limits.deceleration_mps2, to_goal_m.norm());
    CHECK(end_m.norm() <= to_goal_m.norm() + 1e-9);
    // The time-optimal motion from rest to rest takes this long.
    const double optimal_s =
        std::sqrt(2 * to_goal_m.norm() * (1 / limits.acceleration_mps2 + 1 / limits.deceleration_mps2));
    if (optimal_s < to_seconds(hold)) CHECK((to_goal_m - end_m).norm() <= 0.5 * to_goal_m.norm() + 1e-9);
  }
}

}  // namespace sidestep::motion_control_test
