// SPDX-License-Identifier: Apache-2.0
#include "common/motion/trajectory_bounds.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

TEST_CASE("a trajectory never leaves the disc of its outline") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 20'000; ++i) {
    const Trajectory trajectory = random_trajectory(rng);
    const TrajectoryBounds outline = trajectory_bounds(trajectory);
    const double seconds = to_seconds(trajectory.end() - trajectory.start());
    for (int k = 0; k < 20; ++k) {
      const Time t = trajectory.start() + from_seconds(rng.uniform(0, 1.1 * seconds));
      const double off = (trajectory.state_at(t).position_m - outline.disc.centre_m).norm();
      if (off > outline.disc.radius_m) FAIL("trajectory " << i << ": " << off << " m");
    }
    REQUIRE(outline.seconds == Approx(seconds).margin(1e-9));
  }
}

TEST_CASE("an outline is plain when what is left without empty phases are two of moderate size") {
  const Time start = time_from_ns(5);
  Trajectory trajectory(start, {{0, 0}, {1, 0}});
  trajectory.append(Duration{0}, {3, 0});
  trajectory.append(from_seconds(0.1), {1, 0});
  trajectory.append(Duration{0}, {3, 0});
  Trajectory stopping = trajectory;
  append_stop(stopping, 5);
  const TrajectoryBounds outline = trajectory_bounds(stopping);
  CHECK(outline.is_plain);
  CHECK(outline.first_half_mps2 == Vec2(0.5, 0));
  CHECK(outline.second_half_mps2.x() == Approx(-2.5));
  CHECK(outline.second_velocity_mps.x() == Approx(1.1));
  CHECK(trajectory_bounds(Trajectory::resting(start, {1, 2})).is_plain);
  // It ends with a speed, or far away.
  CHECK_FALSE(trajectory_bounds(trajectory).is_plain);
  CHECK_FALSE(trajectory_bounds(Trajectory::resting(start, {1e6, 0})).is_plain);
  Trajectory three(start, {{0, 0}, {0, 0}});
  for (const double a : {1.0, 0.0, -1.0}) three.append(from_seconds(0.1), {a, 0});
  CHECK_FALSE(trajectory_bounds(three).is_plain);
  CHECK(trajectory_bounds(three).disc.radius_m < 0.02);
}
