// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/moving_obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::moving_obstacle_test {

const Time kBegin = time_from_ns(1'000'000'000);

/// Slow reference: the smallest distance of the robot's centre from the obstacle's reach until the robot
/// rests, by dense sampling that is refined around the minimum.
double sampled_separation_m(const Trajectory& trajectory, const MovingObstacle& obstacle) {
  const double seconds = to_seconds(trajectory.end() - trajectory.start());
  const auto at = [&](double s) {
    const Time t = trajectory.start() + from_seconds(s);
    // The last sample is the rest position.
    const Vec2 position =
        t >= trajectory.end() ? trajectory.rest_position_m() : trajectory.state_at(t).position_m;
    return (position - obstacle.position_m).norm() - obstacle.reach_m(t);
  };
  constexpr int kSamples = 2000;
  double min_distance = std::min(at(0), at(seconds));
  int argmin = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double distance = at(seconds * i / kSamples);
    if (distance <= min_distance) argmin = i;
    min_distance = std::min(min_distance, distance);
  }
  const double from = seconds * std::max(0, argmin - 1) / kSamples;
  const double to = seconds * std::min(kSamples, argmin + 1) / kSamples;
  for (int i = 0; i <= kSamples; ++i)
    min_distance = std::min(min_distance, at(from + (to - from) * i / kSamples));
  return min_distance;
}

MovingObstacle random_obstacle(Rng& rng) {
  return {random_vector(rng, 2), rng.uniform(0.02, 0.3), kBegin + from_seconds(rng.uniform(-1, 0.6)),
          rng.chance(0.1) ? 0 : rng.uniform(0, 2)};
}

TEST_CASE("the passive safety check agrees with dense sampling in both directions") {
  const std::uint64_t seed = GENERATE(range(1u, 25u));
  CAPTURE(seed);
  Rng rng(seed);
  int safe = 0, unsafe = 0;
  for (int i = 0; i < 1500; ++i) {
    const Trajectory trajectory = random_trajectory(rng, kBegin);
    if (trajectory.end() == trajectory.start()) continue;  // at rest from the start
    const MovingObstacle obstacle = random_obstacle(rng);
    const double true_separation = sampled_separation_m(trajectory, obstacle);
    // The tested separation is close to the true separation.
    const double sign = rng.chance(0.5) ? 1 : -1, error = sign * std::pow(10, rng.uniform(-8, -1));
    const double separation = true_separation + error;
    if (separation < 0) continue;
    const bool is_safe = is_passively_safe(trajectory, obstacle, separation);
    CAPTURE(i, true_separation, error, obstacle.speed_mps);
    if (is_safe) REQUIRE(separation <= true_separation);
    // Before the observation, the reach shrinks, and its linear interpolation overestimates it.
    if (!is_safe && obstacle.observed_at <= trajectory.start()) REQUIRE(separation >= true_separation - 2e-6);
    ++(is_safe ? safe : unsafe);
  }
  CHECK(safe > 100);
  CHECK(unsafe > 100);
}

TEST_CASE("a robot is safe from an approaching obstacle only if it stops before the obstacle arrives") {
  // Braking at 5 m/s² from 1 m/s takes 0.2 s and 0.1 m. Meanwhile the obstacle approaches by 0.4 m at 2 m/s.
  Trajectory braking(kBegin, {{0, 0}, {1, 0}});
  append_stop(braking, 5);
  const double separation = 0.1, radius = 0.05;
  const MovingObstacle just_far{{0.1 + 0.4 + separation + radius + 1e-5, 0}, radius, kBegin, 2};
  MovingObstacle nearer = just_far;
  nearer.position_m.x() -= 2e-5;
  CHECK(is_passively_safe(braking, just_far, separation));
  CHECK_FALSE(is_passively_safe(braking, nearer, separation));
  // If the obstacle was observed 10 ms earlier, it may have moved 2 cm farther.
  MovingObstacle older = just_far;
  older.observed_at -= from_seconds(0.01);
  CHECK_FALSE(is_passively_safe(braking, older, separation));
  older.position_m.x() += 0.02 + 1e-6;
  CHECK(is_passively_safe(braking, older, separation));
}

TEST_CASE("a robot at rest is passively safe from any obstacle, but a robot that starts to move is not") {
  CHECK(is_passively_safe(Trajectory::resting(kBegin, {0, 0}), {{0.01, 0}, 0.1, kBegin, 2}, 0.1));
  Trajectory empty(kBegin, {{0, 0}, {0, 0}});
  empty.append(Duration{0}, {3, 0});
  CHECK(is_passively_safe(empty, {{0.01, 0}, 0.1, kBegin, 2}, 0.1));
  Trajectory leaving(kBegin, {{0, 0}, {0, 0}});
  leaving.append(from_seconds(0.1), {-3, 0});
  append_stop(leaving, 5);
  CHECK_FALSE(is_passively_safe(leaving, {{0.01, 0}, 0.1, kBegin, 2}, 0.1));
}

TEST_CASE("a short violation between two samples is detected") {
  // The robot passes a small obstacle at rest at 2 m/s. It is 1 mm too near for 14 ms of the 1.9 s.
  Trajectory passing(kBegin, {{-1.5, 0.1}, {2, 0}});
  passing.append(from_seconds(1.5), {0, 0});
  append_stop(passing, 5);
  CHECK_FALSE(is_passively_safe(passing, {{0, 0}, 0.001, kBegin, 0}, 0.1 - 1e-5));
  CHECK(is_passively_safe(passing, {{0, 0}, 0.001, kBegin, 0}, 0.099 - 1e-6));
}

TEST_CASE("an obstacle observed after the trajectory starts may have been elsewhere at the start") {
  Trajectory braking(kBegin, {{0, 0}, {1, 0}});
  append_stop(braking, 5);
  const MovingObstacle obstacle{{-0.3, 0}, 0.05, kBegin + from_seconds(0.2), 1};
  CHECK_FALSE(is_passively_safe(braking, obstacle, 0.1));
  CHECK(is_passively_safe(braking, {{-0.3, 0}, 0.05, kBegin, 1}, 0.1));
}

//   A r B    strangers A and B beside the robot r
TEST_CASE(
    "a robot within reach of strangers may creep away from all of them, but neither fast nor towards one") {
  constexpr double kSeparation_m = 0.1;
  const MovingObstacle left{{-0.25, 0}, 0.09, kBegin, 1.5}, right{{0.25, 0}, 0.09, kBegin, 1.5};
  const std::vector<MovingObstacle> one{left}, two{left, right};
  const auto motion = [](const Vec2& velocity_mps) {
    Trajectory moving(kBegin + Duration{100'000'000}, {{0, 0}, velocity_mps});
    moving.append(Duration{20'000'000}, {0, 0});
    append_stop(moving, 5);
    return moving;
  };
  const auto is_safe = [&](const Vec2& velocity_mps, const std::vector<MovingObstacle>& strangers,
                           double creep_mps = 0.03) {
    return is_passively_safe_from_all(motion(velocity_mps), strangers, kSeparation_m, creep_mps);
  };
  CHECK(is_safe({0.03, 0}, one));
  CHECK_FALSE(is_safe({0.031, 0}, one));
  CHECK_FALSE(is_safe({-0.03, 0}, one));
  CHECK_FALSE(is_safe({-0.001, 0.02}, one));
  CHECK_FALSE(is_safe({0.03, 0}, one, 0));
  CHECK_FALSE(is_safe({0, 0}, one));
  CHECK_FALSE(is_safe({0.03, 0}, two));
  CHECK(is_safe({0, 0.03}, two));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(is_safe({nan, 0}, one));
  CHECK_FALSE(is_safe({0.03, 0}, one, nan));
  CHECK_FALSE(is_safe({0.03, 0}, {{{nan, 0}, 0.09, kBegin, 1.5}}));
}

}  // namespace sidestep::moving_obstacle_test
