// SPDX-License-Identifier: Apache-2.0
// The direction in which an observed robot moves, which other robots use to keep clear of it.
#include <vector>

#include "coordinator/displaced_robots.hpp"
#include "tests/catch.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::mean_velocity_test {

struct Seen {
  Time at;
  Vec2 position_m;
};

/// The mean velocity since the newest observation that is at least 15 cm away. If there is none, since the
/// farthest observation that is at least 1.5 cm away. Uses all observations of the last 0.7 s, without a
/// buffer.
Vec2 reference_velocity_mps(const std::vector<Seen>& seen) {
  const Seen& last = seen.back();
  const Seen* from = nullptr;
  for (auto old = seen.rbegin() + 1; old != seen.rend() && last.at - old->at <= from_seconds(0.7); ++old) {
    const double distance_m = (last.position_m - old->position_m).norm();
    if (distance_m < 0.015) continue;
    if (!from || distance_m >= (last.position_m - from->position_m).norm()) from = &*old;
    if (distance_m >= 0.15) break;
  }
  if (!from) return Vec2(0, 0);
  return (last.position_m - from->position_m) / to_seconds(last.at - from->at);
}

TEST_CASE("an observed robot's velocity is its mean over the last 15 cm, for any motion") {
  const std::uint64_t seed = GENERATE(range(1u, 9u));
  CAPTURE(seed);
  Rng rng(seed);
  const Version a = rest_version(1, {0, 0});
  Ledger ledger(floor_for_tests(), {1});
  ledger.register_robot(1, {&a, 1});
  DisplacedRobots displaced(0.014);
  std::vector<Seen> seen;
  Vec2 position_m(0, 0), velocity_mps(0, 0);
  Time now = at_s(1);
  int resting = 0, moving = 0;
  for (int i = 0; i < 400; ++i) {
    if (i % 40 == 0)
      velocity_mps = Vec2(rng.uniform(-1, 1), rng.uniform(-1, 1)) * (rng.chance(0.3) ? 0.02 : 1.0);
    // At most 40 observations in 0.7 s, as at 60 Hz.
    const double step_s = rng.chance(0.02) ? 0.5 : rng.uniform(0.0181, 0.022);
    now += from_seconds(step_s);
    position_m += velocity_mps * step_s;
    seen.push_back({now, position_m});
    displaced.observe({1, now, position_m, Vec2(0, 0), 0}, ledger);
    const Vec2 expected_mps = reference_velocity_mps(seen);
    const Vec2 found_mps = displaced.last_observation(1)->velocity_mps;
    CAPTURE(i, expected_mps.transpose(), found_mps.transpose());
    REQUIRE((found_mps - expected_mps).norm() < 1e-9);
    ++(expected_mps.norm() > 0 ? moving : resting);
  }
  CHECK(moving > 100);
}

TEST_CASE("a robot that has moved by less than 1.5 cm has no known direction") {
  const Version a = rest_version(1, {0, 0});
  Ledger ledger(floor_for_tests(), {1});
  ledger.register_robot(1, {&a, 1});
  const auto [moved_m, has_direction] = GENERATE(table<double, bool>({{0.0149, false}, {0.0151, true}}));
  CAPTURE(moved_m);
  DisplacedRobots displaced(0.014);
  displaced.observe({1, at_s(1), {0, 0}, Vec2(0, 0), 0}, ledger);
  displaced.observe({1, at_s(1.1), {moved_m, 0}, Vec2(0, 0), 0}, ledger);
  CHECK((displaced.last_observation(1)->velocity_mps.norm() > 0) == has_direction);
}

}  // namespace sidestep::mean_velocity_test
