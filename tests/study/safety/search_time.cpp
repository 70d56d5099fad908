// SPDX-License-Identifier: Apache-2.0
#include "tests/study/safety/search_time.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "agents/navigation/motion_control.hpp"
#include "agents/safety/safety_search.hpp"
#include "common/motion/clearance.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {
namespace {

constexpr double kArea_m2 = 0.7;
constexpr int kMaxAttempts = 8;
constexpr Time kNow = time_from_ns(1'000'000'000'000);
constexpr Duration kCycle{16'666'667};
constexpr int kWarmUps = 2;

/// Samples motions of robots on a jittered grid that are clear of each other. A robot rests if kMaxAttempts
/// samples give no such motion.
std::vector<Version> sample_versions(int robots, const FloorRules& rules, Rng& rng) {
  const double cell_m = std::sqrt(kArea_m2);
  const int columns = static_cast<int>(std::ceil(std::sqrt(robots)));
  const double jitter_m = 0.5 * (cell_m - rules.min_separation_m()) - 0.01;
  std::vector<Version> versions;
  for (int i = 0; i < robots; ++i) {
    const Vec2 corner = -0.5 * cell_m * (columns - 1) * Vec2(1, 1);
    // y is drawn first, because the evaluation order of arguments is unspecified.
    const double y = rng.uniform(-jitter_m, jitter_m), x = rng.uniform(-jitter_m, jitter_m);
    const Vec2 position = corner + cell_m * Vec2(i % columns, i / columns) + Vec2(x, y);
    Trajectory trajectory = Trajectory::resting(kNow, position);
    for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
      const Vec2 direction = rotated({1, 0}, rng.uniform(-std::numbers::pi, std::numbers::pi));
      const Vec2 velocity = rng.uniform(0, rules.limits.speed_mps) * direction;
      const Trajectory moving = accelerate_then_stop(kNow, {position, velocity}, Vec2::Zero(), kCycle,
                                                     rules.limits.deceleration_mps2);
      bool is_free = rules.field.contains(moving.rest_position_m(), rules.radius_m);
      for (const Version& other : versions)
        is_free = is_free && is_clear(moving, other.trajectory, rules.min_separation_m());
      if (!is_free) continue;
      trajectory = moving;
      break;
    }
    versions.push_back({static_cast<RobotId>(i), 1, 1, 0, trajectory});
  }
  return versions;
}

}  // namespace

double search_us_per_robot(int robots, std::uint64_t seed) {
  Rng rng(seed);
  FloorRules rules;
  const double side_m = std::sqrt(kArea_m2) * (std::ceil(std::sqrt(robots)) + 1);
  rules.field = {side_m, side_m};
  const std::vector<Version> versions = sample_versions(robots, rules, rng);
  std::vector<SearchQuery> queries;
  for (const Version& version : versions) {
    const Time start = kNow + kCycle;
    const State there = version.trajectory.state_at(start);
    const double y = rng.uniform(-2, 2), x = rng.uniform(-2, 2);
    const Vec2 to_go(x, y);
    const AccelerationCommand desired =
        desired_acceleration(to_go, there.velocity_mps, rules.limits, kCycle, kCycle);
    SearchQuery query;
    query.start = start;
    query.at_start = there;
    query.desired_mps2 = desired.acceleration_mps2;
    query.hold_time = kCycle;
    query.robot = version.robot;
    queries.push_back(query);
  }
  SafetySearch search(rules);
  TrajectoryIndex index;
  double begin_us = 0;
  for (int round = 0; round <= kWarmUps; ++round) {
    begin_us = cpu_us();
    index.assign(versions);
    for (const SearchQuery& query : queries) static_cast<void>(search.search(query, index, rng));
  }
  return (cpu_us() - begin_us) / robots;
}

}  // namespace sidestep
