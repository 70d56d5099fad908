// SPDX-License-Identifier: Apache-2.0
#include "common/motion/trajectory.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::trajectory_test {

TEST_CASE("a trajectory matches numerical integration") {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const Trajectory trajectory = random_trajectory(rng);
    Vec2 position = trajectory.at_start().position_m, velocity = trajectory.at_start().velocity_mps;
    const Duration step{50'000};
    double error = 0;
    for (Time t = trajectory.start(); t < trajectory.end(); t += step) {
      const Vec2 acceleration = trajectory.motion_at(t + step / 2).acceleration_mps2;
      position += to_seconds(step) * (velocity + 0.5 * to_seconds(step) * acceleration);
      velocity += to_seconds(step) * acceleration;
      error = std::max(error, (trajectory.state_at(t + step).position_m - position).norm());
    }
    CAPTURE(i);
    REQUIRE(error < 2e-3);
  }
}

TEST_CASE("every trajectory with a stop ends at rest and stays at rest") {
  Rng rng(2);
  for (int i = 0; i < 100'000; ++i) {
    const Trajectory trajectory = random_trajectory(rng);
    REQUIRE(trajectory.residual_speed_mps() < 1e-9);
    REQUIRE(trajectory.state_at(trajectory.end()).velocity_mps.norm() == 0);
    REQUIRE((trajectory.state_at(trajectory.end() + std::chrono::hours(1)).position_m -
             trajectory.rest_position_m())
                .norm() == 0);
  }
}

TEST_CASE("the stop decelerates against the velocity at the given rate") {
  Trajectory trajectory(time_from_ns(0), {{0, 0}, {1.2, 1.6}});
  append_stop(trajectory, 5);
  REQUIRE(trajectory.phases().size() == 1);
  CHECK(trajectory.phases()[0].acceleration_mps2.norm() == Approx(5));
  CHECK(trajectory.phases()[0].acceleration_mps2.norm() <= 5);
  CHECK(cross(trajectory.phases()[0].acceleration_mps2, {1.2, 1.6}) == Approx(0).margin(1e-12));
  CHECK(trajectory.rest_position_m().norm() == Approx(2.0 * 2.0 / (2 * 5)));
  const auto before = trajectory.phases().size();
  append_stop(trajectory, 5);
  CHECK(trajectory.phases().size() == before);
}

TEST_CASE("no trajectory exceeds its reach") {
  Rng rng(3);
  for (int i = 0; i < 20'000; ++i) {
    const Trajectory trajectory = random_trajectory(rng);
    const double reach = reach_m(trajectory);
    for (int k = 0; k < 20; ++k) {
      const Time t = trajectory.start() + from_seconds(rng.uniform(0, 2));
      REQUIRE((trajectory.state_at(t).position_m - trajectory.at_start().position_m).norm() <= reach + 1e-12);
    }
  }
}

}  // namespace sidestep::trajectory_test
