// SPDX-License-Identifier: Apache-2.0
#include "tests/study/corners/doorway_scene.hpp"

#include <algorithm>
#include <cmath>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

constexpr std::array kCells_m{0.02, 0.05, 0.1, 0.2};
constexpr double kLength_m = 8,
                 kRoom_m = 1;       // corridor's length; rooms' depth
constexpr double kClear_m = 0.001;  // clearance between people and walls

/// The cells of the floor, and of the corridor in it.
struct Layout {
  MapGrid grid;
  int lane_rows = 0, wall_rows = 0;

  double lane_top_m() const { return grid.y_m(lane_rows); }
  double wall_top_m() const { return grid.y_m(lane_rows + wall_rows); }
};

Layout random_layout(double cell_m, Rng& rng) {
  Layout layout;
  layout.lane_rows = static_cast<int>(std::round(rng.uniform(1, 2) / cell_m));
  layout.wall_rows = std::max(1, static_cast<int>(std::round(rng.uniform(0.05, 0.4) / cell_m)));
  layout.grid.resolution_m = cell_m;
  layout.grid.columns = static_cast<int>(std::round(kLength_m / cell_m));
  layout.grid.rows = layout.lane_rows + layout.wall_rows + static_cast<int>(std::round(kRoom_m / cell_m));
  layout.grid.origin_m = {-layout.grid.columns * cell_m / 2, -layout.grid.rows * cell_m / 2};
  return layout;
}

void sample_driver(Scenario& scenario, Rng& rng) {
  scenario.radius_m = rng.uniform(0.08, 0.2);
  scenario.limits.speed_mps = rng.uniform(0.8, 2);
  scenario.limits.deceleration_mps2 = rng.uniform(3, 5);
  scenario.max_opponent_speed_mps = std::array{0.8, 1.2, 1.6}[rng.below(3)];
  LaserSpec& laser = scenario.laser.emplace();
  laser.settings.beams = 360 + static_cast<int>(rng.below(720));
  laser.settings.max_range_m = rng.uniform(5, 12);
  laser.rate_hz = rng.uniform(10, 40);
  laser.range_error_m = rng.uniform(0.01, 0.04);
  laser.dropout_probability = rng.chance(0.3) ? rng.uniform(0, 0.05) : 0;
  laser.person_radius_m = rng.uniform(0.1, 0.35);
}

/// A person who walks back and forth in a doorway for a while, then steps out and goes back.
OpponentSpec sample_waiting_person(const Scenario& scenario, const Layout& layout, double middle_m,
                                   double width_m, double radius_m, Rng& rng) {
  OpponentSpec person;
  person.radius_m = radius_m;
  person.speed_mps = scenario.max_opponent_speed_mps * (rng.chance(0.6) ? 1 : rng.uniform(0.4, 1));
  const double play_m = width_m / 2 - radius_m - kClear_m;
  const double x = middle_m + rng.uniform(-play_m, play_m);
  const double top_m = layout.grid.extent().max_m.y() - radius_m - kClear_m;
  const double lane_m = layout.lane_top_m();
  const double low_m = lane_m + rng.uniform(-0.5, 1) * radius_m;
  const double high_m = std::min(low_m + rng.uniform(0.02, 0.3), top_m);
  const double waits_m = rng.uniform(0.5, 12) * person.speed_mps;
  for (double walked_m = 0; walked_m < waits_m; walked_m += 2 * (high_m - low_m)) {
    person.path_m.emplace_back(x, high_m);
    person.path_m.emplace_back(x, low_m);
  }
  const double bottom_m = layout.grid.origin_m.y() + radius_m + kClear_m;
  person.path_m.emplace_back(x, high_m);
  person.path_m.emplace_back(x, std::max(bottom_m, lane_m - rng.uniform(0.2, 2)));
  return person;
}

/// Cuts doorways into the wall beside the corridor, and puts people into them.
void add_doorways(Scenario& scenario, const Layout& layout, BitGrid& blocked, Rng& rng) {
  const double cell_m = layout.grid.resolution_m, smallest_m = scenario.laser->person_radius_m;
  const auto cells = [=](double length_m) { return static_cast<int>(std::ceil(length_m / cell_m - 1e-9)); };
  int column = cells(rng.uniform(0.8, 1.5));
  while (true) {
    const double radius_m = smallest_m * (rng.chance(0.7) ? 1 : rng.uniform(1, 1.4));
    const double tight_m = 2 * (radius_m + kClear_m) + (rng.chance(0.6) ? rng.uniform(0, 0.15) : 0);
    const int columns = cells(std::max(tight_m, rng.chance(0.6) ? 0.3 : rng.uniform(0.3, 1.2)));
    const int end = column + columns;
    if (end + cells(0.3) >= layout.grid.columns) return;
    for (int row = layout.lane_rows; row < layout.lane_rows + layout.wall_rows; ++row)
      blocked.set_run(column, end, row, false);
    const double middle_m = (layout.grid.x_m(column) + layout.grid.x_m(end)) / 2;
    if (rng.chance(0.8))
      scenario.opponents.push_back(
          sample_waiting_person(scenario, layout, middle_m, columns * cell_m, radius_m, rng));
    column = end + cells(rng.uniform(0.3, 1.5));
  }
}

}  // namespace

Scenario doorway_scene(std::size_t kind, std::uint64_t seed) {
  Rng rng(seed * kDoorwayKinds.size() + kind);
  while (true) {
    const Layout layout = random_layout(kCells_m.at(kind), rng);
    const Box floor = layout.grid.extent();
    Scenario scenario;
    scenario.name = "doorways";
    scenario.field = {floor.max_m.x() - floor.min_m.x(), floor.max_m.y() - floor.min_m.y()};
    scenario.time_limit_s = 40;
    sample_driver(scenario, rng);
    BitGrid blocked(layout.grid.columns, layout.grid.rows);
    for (int row = layout.lane_rows; row < layout.lane_rows + layout.wall_rows; ++row)
      blocked.set_run(0, layout.grid.columns, row);
    add_doorways(scenario, layout, blocked, rng);
    scenario.map = std::make_shared<const FloorMap>(OccupancyMap(layout.grid, std::move(blocked)));
    const double room_m = scenario.radius_m + scenario.margin_m + 0.05;
    const auto random_y = [&] { return rng.uniform(floor.min_m.y() + room_m, layout.lane_top_m() - room_m); };
    const double end_m = kLength_m / 2 - room_m - 0.1;
    RobotSpec robot;
    robot.start_m = {-end_m, random_y()};
    robot.start_heading_rad = rng.uniform(-3, 3);
    for (const double side : {1, -1, 1})
      robot.goals.push_back({Vec2(side * end_m, random_y()), std::nullopt});
    scenario.robots = {robot};
    const bool begins_free = std::ranges::all_of(scenario.opponents, [&](const OpponentSpec& person) {
      return (person.path_m.front() - robot.start_m).norm() > person.radius_m + scenario.radius_m + 0.3;
    });
    if (!scenario.opponents.empty() && begins_free) return scenario;
  }
}

}  // namespace sidestep
