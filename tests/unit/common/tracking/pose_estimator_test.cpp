// SPDX-License-Identifier: Apache-2.0
#include "common/tracking/pose_estimator.hpp"

#include <cmath>
#include <deque>
#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/random/normal_vector.hpp"

namespace sidestep::pose_estimator_test {

constexpr Duration kPeriod = EstimatorSettings{}.period;

using std::chrono::milliseconds;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

// A robot that drives in a circle, with a constant scale error of its odometry and delayed fixes.
struct CirclingRobot {
  explicit CirclingRobot(std::uint64_t seed, double scale_error)
      : rng(seed), scale(1 + scale_error), estimator({1, 0}, 0, kBegin, {0.01, 0.005, 0.0015}) {}

  Vec2 position(Time t) const { return rotated(Vec2(1, 0), 1.5 * to_seconds(t - kBegin)); }

  void step() {
    const Vec2 before = position(now);
    now += kPeriod;
    const Vec2 velocity = (position(now) - before) / to_seconds(kPeriod);
    const Vec2 acceleration = -1.5 * 1.5 * position(now);
    estimator.advance(now, {velocity * scale + 0.01 * normal_vector(rng), 0.1 * rng.normal()}, acceleration,
                      0);
    if (++steps % 17 == 0) {
      waiting.push_back({now, position(now) + 0.0015 * normal_vector(rng)});
    }
    if (!waiting.empty() && waiting.front().first + milliseconds(35) <= now) {
      REQUIRE(estimator.correct(waiting.front().first, waiting.front().second, 0.005 * rng.normal()));
      waiting.pop_front();
    }
  }

  Rng rng;
  double scale;
  PoseEstimator estimator;
  Time now = kBegin;
  int steps = 0;
  std::deque<std::pair<Time, Vec2>> waiting;
};

TEST_CASE("late and noisy fixes keep the estimate within a fraction of their noise") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  CirclingRobot run(seed, 0.01);
  double sum = 0;
  for (int i = 0; i < 30'000; ++i) {
    run.step();
    if (i >= 5000) sum += (run.estimator.position_m() - run.position(run.now)).squaredNorm();
  }
  CHECK(std::sqrt(sum / 25'000) < 0.0007);
  CHECK(std::abs(run.estimator.scale_error() - 0.01) < 0.001);
  CHECK(std::abs(run.estimator.heading_rad()) < 0.01);
  CHECK((run.estimator.velocity_mps() - 1.5 * left_of(run.position(run.now))).norm() < 0.02);
}

TEST_CASE("a fix is compared with the estimate at the fix's capture time, not with the current estimate") {
  PoseEstimator estimator({0, 0}, 0, kBegin, {});
  Time now = kBegin;
  for (int i = 0; i < 100; ++i) estimator.advance(now += kPeriod, {{2, 0}, 0}, {0, 0}, 0);
  REQUIRE(estimator.correct(kBegin + milliseconds(40), {0.08, 0}, 0));
  CHECK((estimator.position_m() - Vec2(0.2, 0)).norm() < 1e-9);
  // A fix captured between two control periods.
  REQUIRE(estimator.correct(kBegin + std::chrono::microseconds(60'250), {0.1205, 0}, 0));
  CHECK((estimator.position_m() - Vec2(0.2, 0)).norm() < 1e-9);
}

TEST_CASE("an invalid fix changes nothing") {
  PoseEstimator estimator({0, 0}, 0, kBegin, {});
  Time now = kBegin;
  for (int i = 0; i < 1000; ++i) estimator.advance(now += kPeriod, {{1, 0}, 0}, {0, 0}, 0);
  REQUIRE(estimator.correct(now - milliseconds(30), {0.97, 0}, 0));
  const Vec2 before = estimator.position_m();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(estimator.correct(now - milliseconds(10), {nan, 0}, 0));
  CHECK_FALSE(estimator.correct(now - milliseconds(10), {0, std::numeric_limits<double>::infinity()}, 0));
  CHECK_FALSE(estimator.correct(now - milliseconds(10), {0, 0}, nan));
  CHECK_FALSE(estimator.correct(now + milliseconds(1), {5, 5}, 0));
  CHECK_FALSE(estimator.correct(now - milliseconds(30), {5, 5}, 0));
  CHECK_FALSE(estimator.correct(now - milliseconds(31), {5, 5}, 0));
  CHECK_FALSE(estimator.correct(Time::min(), {5, 5}, 0));
  CHECK_FALSE(estimator.correct(Time::max(), {5, 5}, 0));
  CHECK(estimator.position_m() == before);
}

TEST_CASE("a fix older than the estimator's history is refused, and a fix within it is used") {
  PoseEstimator estimator({0, 0}, 0, kBegin, {});
  Time now = kBegin;
  for (int i = 0; i < 1000; ++i) estimator.advance(now += kPeriod, {}, {0, 0}, 0);
  CHECK_FALSE(estimator.correct(now - milliseconds(512), {0, 0}, 0));
  CHECK(estimator.correct(now - milliseconds(500), {0, 0}, 0));
}

TEST_CASE("after a gap in time, fixes from before the gap are refused") {
  PoseEstimator estimator({0, 0}, 0, kBegin, {});
  Time now = kBegin;
  for (int i = 0; i < 100; ++i) estimator.advance(now += kPeriod, {}, {0, 0}, 0);
  now += milliseconds(10);
  for (int i = 0; i < 20; ++i) estimator.advance(now += kPeriod, {}, {0, 0}, 0);
  CHECK_FALSE(estimator.correct(now - milliseconds(25), {0, 0}, 0));
  CHECK(estimator.correct(now - milliseconds(15), {0, 0}, 0));
}

TEST_CASE("carrying a robot while its wheels roll is not mistaken for an odometry error") {
  const double rolls_mps = GENERATE(-0.2, -0.1, 0.0, 0.1, 0.2);
  CAPTURE(rolls_mps);
  const EstimatorSettings settings{0.01, 0.005, 0.0005};
  Rng rng(1);
  Time now = kBegin;
  Vec2 position_m(0, 0);
  const Vec2 carried_mps(0.3, 0);
  PoseEstimator estimator(position_m, 0, now, settings);
  for (int i = 0; i < 7000; ++i) {
    now += kPeriod;
    position_m += carried_mps * to_seconds(kPeriod);
    estimator.advance(now, {Vec2(rolls_mps, 0) + 0.01 * normal_vector(rng), 0}, Vec2(0, 0), 0);
    if (i % 17 == 0) (void)estimator.correct(now, position_m + 0.0005 * normal_vector(rng), 0);
  }
  CHECK(std::abs(estimator.scale_error()) <= 5 * settings.scale_error);
}

TEST_CASE("a single outlier moves the estimate only slightly") {
  CirclingRobot run(5, 0);
  for (int i = 0; i < 5000; ++i) run.step();
  REQUIRE(run.estimator.correct(run.now, {50, 50}, 0));
  CHECK((run.estimator.position_m() - run.position(run.now)).norm() < 0.003);
}

TEST_CASE("two fixes of a robot that was put elsewhere give it its new place and heading") {
  PoseEstimator estimator({1, 0}, 0.2, kBegin, {0.01, 0.005, 0.0015});
  Time now = kBegin;
  const auto rest_until = [&](Time until) {
    for (; now < until; now += kPeriod) estimator.advance(now + kPeriod, {}, {0, 0}, 0);
  };
  for (int i = 1; i <= 2; ++i) {
    rest_until(kBegin + i * milliseconds(17));
    REQUIRE(estimator.correct(now - milliseconds(5), {-2, 1}, 2.5));
  }
  CHECK(estimator.jump_m() > 3);
  CHECK((estimator.position_m() - Vec2(-2, 1)).norm() < 0.01);
  CHECK(wrapped_rad(estimator.heading_rad() - 2.5) == Approx(0).margin(0.01));
}

// A base that follows its commands by this part, and does not measure its motion.
struct CommandedRobot {
  explicit CommandedRobot(std::uint64_t seed) : rng(seed) {}

  /// Drives in a circle for a while. Returns the number of displacements that were found.
  int drive(Duration duration, double part) {
    int jumps = 0;
    for (const Time end = now + duration; now < end;) {
      const Vec2 commanded_mps = rotated(Vec2(1.3, 0), 0.7 * to_seconds(now - kBegin));
      now += settings.period;
      position_m += part * to_seconds(settings.period) * commanded_mps;
      estimator.advance(now, {commanded_mps, 0}, {0, 0}, 0, false);
      if (++steps % 2 == 0) waiting.push_back({now, position_m + 0.0015 * normal_vector(rng)});
      if (waiting.empty() || waiting.front().first + milliseconds(60) > now) continue;
      REQUIRE(estimator.correct(waiting.front().first, waiting.front().second, 0));
      waiting.pop_front();
      jumps += estimator.jump_m() > 0 ? 1 : 0;
    }
    return jumps;
  }

  EstimatorSettings settings{.velocity_noise_mps = 0.01,
                             .scale_error = 0.2,
                             .fix_noise_m = 0.0015,
                             .velocity_gain = 1,
                             .period = milliseconds(10),
                             .commanded_noise_mps = 0.05};
  Rng rng;
  Time now = kBegin;
  Vec2 position_m{0, 0};
  PoseEstimator estimator{position_m, 0, kBegin, settings};
  int steps = 0;
  std::deque<std::pair<Time, Vec2>> waiting;
};

TEST_CASE("a robot that suddenly follows its commands by another part learns that at once") {
  const std::uint64_t seed = GENERATE(1, 2, 3, 4, 5);
  const double before = GENERATE(1.0, 0.98), after = GENERATE(0.66, 0.8);
  CAPTURE(seed, before, after);
  CommandedRobot run(seed);
  run.drive(std::chrono::seconds(3), before);
  CHECK(std::abs(1 - run.estimator.scale_error() - before) < 0.02);
  CHECK(run.estimator.odometry_scale_stddev() < 0.01);
  CHECK(run.drive(milliseconds(300), after) <= 2);
  CHECK(std::abs(1 - run.estimator.scale_error() - after) < 0.04);
  CHECK((run.estimator.position_m() - run.position_m).norm() < 0.006);
  CHECK(run.drive(std::chrono::seconds(3), after) == 0);
  CHECK(std::abs(1 - run.estimator.scale_error() - after) < 0.02);
}

}  // namespace sidestep::pose_estimator_test
