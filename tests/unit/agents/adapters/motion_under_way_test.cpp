// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/motion_under_way.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random/rng.hpp"
#include "common/robot/robot_version.hpp"
#include "tests/catch.hpp"

namespace sidestep::motion_under_way_test {
namespace {

using namespace std::chrono_literals;

/// A base's path under commands that are each held for `period`.
std::vector<PathPoint> path_of(const std::vector<Vec2>& velocities_mps, Duration period) {
  std::vector<PathPoint> path{{Duration{0}, {1, 2}}};
  for (const Vec2& velocity : velocities_mps)
    path.push_back({path.back().after + period, path.back().position_m + to_seconds(period) * velocity});
  return path;
}

/// The largest distance of the motion from the path, measured in small steps.
double sampled_error_m(const std::vector<PathPoint>& path, const robot::MotionUnderWay<float>& motion) {
  robot::Version version;
  version.x_m = path.front().position_m.x();
  version.y_m = path.front().position_m.y();
  version.vx_mps = motion.from_mps.x;
  version.vy_mps = motion.from_mps.y;
  auto velocity = motion.from_mps;
  for (int i = 0; i < motion.part_count; ++i) {
    const auto& [duration_ns, end] = motion.parts[i];
    const double s = robot::seconds_of(duration_ns);
    version.phases[version.phase_count++] = {duration_ns, (end.x - velocity.x) / s, (end.y - velocity.y) / s};
    velocity = end;
  }
  double largest_m = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    for (int part = 0; part < 20; ++part) {
      const Duration at = path[i].after + (path[i + 1].after - path[i].after) * part / 20;
      const Vec2 there = path[i].position_m + part / 20.0 * (path[i + 1].position_m - path[i].position_m);
      const auto place = robot::motion_at<double>(version, at.count()).position_m;
      largest_m = std::max(largest_m, (Vec2(place.x, place.y) - there).norm());
    }
  }
  return largest_m;
}

Duration duration_of(const robot::MotionUnderWay<float>& motion) {
  Duration sum{0};
  for (int i = 0; i < motion.part_count; ++i) sum += Duration{motion.parts[i].duration_ns};
  return sum;
}

}  // namespace

/// The largest acceleration of the motion.
double acceleration_mps2(const robot::MotionUnderWay<float>& motion) {
  double largest_mps2 = 0;
  auto velocity = motion.from_mps;
  for (int i = 0; i < motion.part_count; ++i) {
    const auto& [duration_ns, end] = motion.parts[i];
    const double change_mps = std::hypot(end.x - velocity.x, end.y - velocity.y);
    largest_mps2 = std::max(largest_mps2, change_mps / robot::seconds_of(duration_ns));
    velocity = end;
  }
  return largest_mps2;
}

TEST_CASE("a motion fitted to random commands has valid accelerations and a valid error bound") {
  const auto seed = GENERATE(range(1u, 301u));
  CAPTURE(seed);
  Rng rng(seed);
  // Commands change every few milliseconds. The first and the last one may last only a microsecond.
  std::vector<PathPoint> path{{Duration{0}, {1, 2}}};
  const auto changes = 1 + rng.below(40);
  Vec2 velocity{rng.uniform(-2, 2), rng.uniform(-2, 2)};
  for (std::uint64_t i = 0; i < changes; ++i) {
    const bool is_end = i == 0 || i + 1 == changes || rng.chance(0.1);
    const Duration length =
        from_seconds(is_end ? 1e-6 * std::pow(1e4, rng.uniform()) : rng.uniform(0.004, 0.02));
    const double step = rng.chance(0.2) ? 3 : 0.1;
    velocity += Vec2(rng.uniform(-step, step), rng.uniform(-step, step));
    path.push_back({path.back().after + length, path.back().position_m + to_seconds(length) * velocity});
  }
  const auto motion = fit_motion_under_way(path, velocity);
  CHECK(duration_of(motion) == path.back().after);
  CHECK(acceleration_mps2(motion) < 1000);
  CHECK(sampled_error_m(path, motion) <= motion.error_m + 1e-6);
}

TEST_CASE("no motion is under way if motors obey immediately") {
  CHECK(fit_motion_under_way(path_of({}, 10ms), {0, 0}).part_count == 0);
  CHECK(fit_motion_under_way({}, {0, 0}).part_count == 0);
}

TEST_CASE("a motion that accelerates, brakes and rests is fitted within a fraction of a millimetre") {
  std::vector<Vec2> velocities;
  for (int i = 0; i < 12; ++i) velocities.push_back(Vec2(0.03, -0.01) * (i + 0.5));
  for (int i = 0; i < 8; ++i) velocities.push_back(Vec2(0.045, -0.015) * (7.5 - i));
  for (int i = 0; i < 10; ++i) velocities.emplace_back(0, 0);
  const auto path = path_of(velocities, 10ms);
  const auto motion = fit_motion_under_way(path, velocities.back());
  CHECK(motion.part_count == 3);
  CHECK(duration_of(motion) == 300ms);
  CHECK(motion.error_m < 0.0004);
}

TEST_CASE(
    "a fitted motion lasts as long as the path, has its final velocity, and stays within its stated error") {
  double worst_ratio = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<Vec2> velocities;
    Vec2 velocity(rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5)), change(0, 0);
    const std::size_t steps = 1 + rng.below(31);
    const bool is_rough = rng.chance(0.2);
    for (std::size_t i = 0; i < steps; ++i) {
      if (rng.chance(is_rough ? 0.9 : 0.15)) change = {rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05)};
      velocities.push_back(velocity += change);
    }
    const Duration period{static_cast<std::int64_t>(rng.uniform(2e6, 1e7))};
    const auto path = path_of(velocities, period);
    const auto motion = fit_motion_under_way(path, velocities.back());
    REQUIRE(motion.part_count >= 1);
    REQUIRE(duration_of(motion) == path.back().after);
    const auto& end = motion.parts[motion.part_count - 1].end_velocity_mps;
    REQUIRE((Vec2(end.x, end.y) - velocities.back()).norm() < 1e-6);
    const double sampled_m = sampled_error_m(path, motion);
    REQUIRE(sampled_m <= motion.error_m);
    if (motion.error_m > 0.001) worst_ratio = std::max(worst_ratio, motion.error_m / sampled_m);
  }
  // The bound is hardly larger than the actual error.
  CHECK(worst_ratio < 1.2);
}

TEST_CASE("a path with a NaN never gets a small error bound") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto path = path_of({{1, 0}, {1, 0}, {1, 0}, {1, 0}}, 10ms);
  path[2].position_m.x() = nan;
  CHECK_FALSE(fit_motion_under_way(path, {1, 0}).error_m <= 1e9);
}

}  // namespace sidestep::motion_under_way_test
