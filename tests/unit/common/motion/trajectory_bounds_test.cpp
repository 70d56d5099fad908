// SPDX-License-Identifier: Apache-2.0
#include "common/motion/trajectory_bounds.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::trajectory_bounds_test {

TEST_CASE("a trajectory stays within the disc of its bounds") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 20'000; ++i) {
    const Trajectory trajectory = random_trajectory(rng);
    const TrajectoryBounds bounds = trajectory_bounds(trajectory);
    const double seconds = to_seconds(trajectory.end() - trajectory.start());
    for (int k = 0; k < 20; ++k) {
      const Time t = trajectory.start() + from_seconds(rng.uniform(0, 1.1 * seconds));
      const double off = (trajectory.state_at(t).position_m - bounds.disc.centre_m).norm();
      if (off > bounds.disc.radius_m) FAIL("trajectory " << i << " is " << off << " m off");
    }
  }
}

TEST_CASE("bounds are batchable if the trajectory has at most two non-empty phases and moderate numbers") {
  const Time start = time_from_ns(5);
  Trajectory trajectory(start, {{0, 0}, {1, 0}});
  trajectory.append(Duration{0}, {3, 0});
  trajectory.append(from_seconds(0.1), {1, 0});
  trajectory.append(Duration{0}, {3, 0});
  Trajectory stopping = trajectory;
  append_stop(stopping, 5);
  const TrajectoryBounds bounds = trajectory_bounds(stopping);
  CHECK(bounds.is_batchable);
  CHECK(bounds.first_half_mps2 == Vec2(0.5, 0));
  CHECK(bounds.second_half_mps2.x() == Approx(-2.5));
  CHECK(bounds.second_velocity_mps.x() == Approx(1.1));
  CHECK(trajectory_bounds(Trajectory::resting(start, {1, 2})).is_batchable);
  // The trajectory does not end at rest, and is too far away.
  CHECK_FALSE(trajectory_bounds(trajectory).is_batchable);
  CHECK_FALSE(trajectory_bounds(Trajectory::resting(start, {1e6, 0})).is_batchable);
  Trajectory three(start, {{0, 0}, {0, 0}});
  for (const double a : {1.0, 0.0, -1.0}) three.append(from_seconds(0.1), {a, 0});
  CHECK_FALSE(trajectory_bounds(three).is_batchable);
  CHECK(trajectory_bounds(three).disc.radius_m < 0.02);
}

}  // namespace sidestep::trajectory_bounds_test
