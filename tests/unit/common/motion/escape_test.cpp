// SPDX-License-Identifier: Apache-2.0
#include "common/motion/escape.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::escape_test {

/// The distance between two trajectories from `from` on. Because of sampling, never below the true distance.
double sampled_distance_m(const Trajectory& a, const Trajectory& b, Time from) {
  const Time to = std::max({a.end(), b.end(), from}) + std::chrono::milliseconds(1);
  double smallest = 1e9;
  for (Time t = from; t <= to; t += std::chrono::milliseconds(1))
    smallest = std::min(smallest, (a.state_at(t).position_m - b.state_at(t).position_m).norm());
  return smallest;
}

TEST_CASE("the remaining trajectory equals the original from the given time on") {
  Rng rng(4);
  for (int i = 0; i < 500; ++i) {
    const Trajectory whole = random_trajectory(rng);
    const double length_s = to_seconds(whole.end() - whole.start());
    const Time from = whole.start() + from_seconds(rng.uniform(-0.2, 1.2 * length_s + 0.1));
    const Trajectory remaining = remaining_trajectory(whole, from);
    CHECK(remaining.start() == std::max(from, whole.start()));
    CHECK(remaining.end() == std::max(whole.end(), remaining.start()));
    for (int k = 0; k <= 20; ++k) {
      const Time t = remaining.start() + from_seconds(k * length_s / 18);
      CHECK((remaining.state_at(t).position_m - whole.state_at(t).position_m).norm() < 1e-9);
      CHECK((remaining.state_at(t).velocity_mps - whole.state_at(t).velocity_mps).norm() < 1e-9);
    }
  }
}

TEST_CASE("the relaxed separation is the minimum separation or the base's distance, whichever is smaller") {
  Rng rng(5);
  int smaller = 0;
  for (int i = 0; i < 500; ++i) {
    const Trajectory base = random_trajectory(rng), other = random_trajectory(rng);
    const Time from = base.start() + from_seconds(rng.uniform(0, 1));
    const double min_separation_m = rng.uniform(0.1, 1.5);
    const double relaxed = relaxed_separation_m(base, from, other, min_separation_m);
    const double sampled = sampled_distance_m(base, other, std::max(from, other.start()));
    CAPTURE(i, min_separation_m, relaxed, sampled);
    CHECK(relaxed <= min_separation_m);
    CHECK(relaxed <= sampled);
    if (relaxed < min_separation_m) {
      ++smaller;
      CHECK(relaxed >= sampled - 0.01);  // one sampling step of 1 ms at 10 m/s
    }
  }
  CHECK(smaller > 50);
}

TEST_CASE("a robot that is too close to a blocked cell may move away from the cell but not nearer") {
  MapGrid grid;
  grid.columns = grid.rows = 40, grid.resolution_m = 0.1, grid.origin_m = {-2, -2};
  BitGrid blocked(grid.columns, grid.rows);
  for (int column = 20; column < 25; ++column)
    for (int row = 18; row < 22; ++row) blocked.set(column, row);  // x from 0 to 0.5 m, y within 0.2 m
  FloorRules rules;
  rules.map = std::make_shared<const FloorMap>(OccupancyMap(grid, blocked));
  const double nearest_m = -(rules.radius_m + rules.margin_m) + 0.01;
  const Trajectory base = Trajectory::resting(Time{}, {nearest_m, 0});
  const auto validity = [&](const Vec2& velocity_mps) {
    Version version;
    version.trajectory = Trajectory(Time{} + std::chrono::milliseconds(10), {{nearest_m, 0}, velocity_mps});
    append_stop(version.trajectory, 5);
    return check_workspace_with_escape(version, base, rules);
  };
  CHECK(validity({0, 0}) == Validity::kValid);
  CHECK(validity({-0.5, 0}) == Validity::kValid);
  CHECK(validity({0, 0.3}) == Validity::kValid);
  CHECK(validity({0.1, 0}) == Validity::kObstacle);
  CHECK(check_workspace(base, rules) == Validity::kObstacle);
}

}  // namespace sidestep::escape_test
