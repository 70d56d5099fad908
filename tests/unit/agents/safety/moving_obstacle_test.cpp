// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/moving_obstacle.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kBegin = time_from_ns(1'000'000'000);

/// Independent and slow: how much room is left between the robot's centre and the obstacle's reach, over a
/// dense sampling of the time before rest, refined about the least.
double sampled_room_m(const Trajectory& trajectory, const MovingObstacle& obstacle) {
  const double seconds = to_seconds(trajectory.end() - trajectory.start());
  const auto at = [&](double s) {
    const Time t = trajectory.start() + from_seconds(s);
    // The end itself is at rest, but only just: take its place.
    const Vec2 place =
        t >= trajectory.end() ? trajectory.rest_position_m() : trajectory.state_at(t).position_m;
    return (place - obstacle.position_m).norm() - obstacle.reach_m(t);
  };
  constexpr int kSamples = 2000;
  double least = std::min(at(0), at(seconds));
  int best = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double here = at(seconds * i / kSamples);
    if (here <= least) best = i;
    least = std::min(least, here);
  }
  const double from = seconds * std::max(0, best - 1) / kSamples;
  const double to = seconds * std::min(kSamples, best + 1) / kSamples;
  for (int i = 0; i <= kSamples; ++i) least = std::min(least, at(from + (to - from) * i / kSamples));
  return least;
}

MovingObstacle random_obstacle(Rng& rng) {
  return {random_vector(rng, 2), rng.uniform(0.02, 0.3), kBegin + from_seconds(rng.uniform(-1, 0.6)),
          rng.chance(0.1) ? 0 : rng.uniform(0, 2)};
}

}  // namespace

TEST_CASE("a robot that is said to rest first does so at every sampled instant, and the other way round") {
  const std::uint64_t seed = GENERATE(range(1u, 25u));
  CAPTURE(seed);
  Rng rng(seed);
  int yes = 0, no = 0;
  for (int i = 0; i < 1500; ++i) {
    const Trajectory trajectory = random_trajectory(rng, kBegin);
    if (trajectory.end() == trajectory.start()) continue;  // at rest from the beginning
    const MovingObstacle obstacle = random_obstacle(rng);
    const double room = sampled_room_m(trajectory, obstacle);
    // Just about as much as there is.
    const double off = (rng.chance(0.5) ? 1 : -1) * std::pow(10, rng.uniform(-8, -1));
    const double keep = room + off;
    if (keep < 0) continue;
    const bool rests = rests_before(trajectory, obstacle, keep);
    CAPTURE(i, room, off, obstacle.speed_mps);
    if (rests) REQUIRE(keep <= room);
    // Before it was seen the reach shrinks, and may be taken for larger than it is.
    if (!rests && obstacle.seen_at <= trajectory.start()) REQUIRE(keep >= room - 2e-6);
    ++(rests ? yes : no);
  }
  CHECK(yes > 100);
  CHECK(no > 100);
}

TEST_CASE("a robot that brakes in time from an obstacle that comes at it has rested before, and not later") {
  // 1 m/s, braking at 5: 0.2 s and 0.1 m. Meanwhile the obstacle comes 0.4 m nearer at 2 m/s.
  Trajectory braking(kBegin, {{0, 0}, {1, 0}});
  append_stop(braking, 5);
  const double keep = 0.1, radius = 0.05;
  const MovingObstacle just_far{{0.1 + 0.4 + keep + radius + 1e-5, 0}, radius, kBegin, 2};
  MovingObstacle nearer = just_far;
  nearer.position_m.x() -= 2e-5;
  CHECK(rests_before(braking, just_far, keep));
  CHECK_FALSE(rests_before(braking, nearer, keep));
  // Seen 10 ms earlier it may have come 2 cm farther.
  MovingObstacle older = just_far;
  older.seen_at -= from_seconds(0.01);
  CHECK_FALSE(rests_before(braking, older, keep));
  older.position_m.x() += 0.02 + 1e-6;
  CHECK(rests_before(braking, older, keep));
}

TEST_CASE("a robot that stands has promised nothing more, however near the obstacle is") {
  CHECK(rests_before(Trajectory::resting(kBegin, {0, 0}), {{0.01, 0}, 0.1, kBegin, 2}, 0.1));
  Trajectory empty(kBegin, {{0, 0}, {0, 0}});
  empty.append(Duration{0}, {3, 0});
  CHECK(rests_before(empty, {{0.01, 0}, 0.1, kBegin, 2}, 0.1));
  Trajectory leaving(kBegin, {{0, 0}, {0, 0}});
  leaving.append(from_seconds(0.1), {-3, 0});
  append_stop(leaving, 5);
  CHECK_FALSE(rests_before(leaving, {{0.01, 0}, 0.1, kBegin, 2}, 0.1));
}

TEST_CASE("what dashes past between two samples of the way is not overlooked") {
  // 2 m/s past a thin obstacle at rest: 1 mm too near for 8 ms of the 2 s.
  Trajectory passing(kBegin, {{-1.5, 0.1}, {2, 0}});
  passing.append(from_seconds(1.5), {0, 0});
  append_stop(passing, 5);
  CHECK_FALSE(rests_before(passing, {{0, 0}, 0.001, kBegin, 0}, 0.1 - 1e-5));
  CHECK(rests_before(passing, {{0, 0}, 0.001, kBegin, 0}, 0.099 - 1e-6));
}

TEST_CASE(
    "an obstacle whose sight is stamped later than the trajectory begins may have been elsewhere before") {
  Trajectory braking(kBegin, {{0, 0}, {1, 0}});
  append_stop(braking, 5);
  const MovingObstacle obstacle{{-0.3, 0}, 0.05, kBegin + from_seconds(0.2), 1};
  CHECK_FALSE(rests_before(braking, obstacle, 0.1));
  CHECK(rests_before(braking, {{-0.3, 0}, 0.05, kBegin, 1}, 0.1));
}
