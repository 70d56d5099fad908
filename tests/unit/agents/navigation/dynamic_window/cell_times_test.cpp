// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/collision_table.hpp"
#include "agents/navigation/dynamic_window/disc_cell_times.hpp"
#include "agents/navigation/dynamic_window/hull.hpp"
#include "agents/navigation/dynamic_window/hull_cell_times.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::cell_times_test {

constexpr GridWindow kAll{{0, kGridSide - 1}, {0, kGridSide - 1}};
constexpr double kHorizon_s = 0.75;  // exactly representable in single precision

/// Compares the times of random cells and velocities with the minimum over many points of the cell.
/// `exact(point, row, column)` is the exact time; negative if the velocity is forbidden.
template <typename Exact>
void compare_with_points(const CellTimes& times, Rng& rng, Exact exact) {
  constexpr int kPoints = 24;  // points along each side of a cell
  int compared = 0;
  double sum_off_s = 0;
  for (int i = 0; i < 20'000 && compared < 2500; ++i) {
    const int column = static_cast<int>(rng.below(static_cast<std::uint64_t>(times.grid.columns)));
    const int row = static_cast<int>(rng.below(static_cast<std::uint64_t>(times.grid.rows)));
    const int u = static_cast<int>(rng.below(kGridSide)), v = static_cast<int>(rng.below(kGridSide));
    const std::size_t cell = times.grid.index(column, row);
    const double stored_s = static_cast<double>(times.of(cell)[slot_of(u, v)]);
    if (times.touches_hull[cell] || exact(Vec2(0, 0), u, v) < 0) continue;
    double least_s = kHorizon_s;
    const Box box = times.grid.cell(column, row);
    // The first point of a cell to collide lies on its boundary.
    for (int k = 0; k < 4 * kPoints; ++k) {
      const auto corners = corners_of(box);
      const Vec2 from = corners[static_cast<std::size_t>(k / kPoints)];
      const Vec2 to = corners[static_cast<std::size_t>((k / kPoints + 1) % 4)];
      least_s = std::min(least_s, exact(from + (k % kPoints) * (to - from) / kPoints, u, v));
    }
    CAPTURE(column, row, u, v, stored_s, least_s);
    REQUIRE(stored_s <= least_s);
    if (least_s == kHorizon_s && stored_s == Approx(kHorizon_s)) continue;
    ++compared;
    sum_off_s += least_s - stored_s;
  }
  CHECK(compared > 300);
  // Only some points are sampled, so their minimum may be slightly later.
  CHECK(sum_off_s / compared < 1e-3);
}

TEST_CASE("cell times are the minimum over all points of the cell, for hulls") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  const ConvexPolygon hull = random_hull(rng, 0.25);
  const DifferentialDrive drive;
  const Hull outline(hull);
  const CellTimes times = hull_cell_times(drive, hull, 0.06, kHorizon_s);
  compare_with_points(times, rng, [&](const Vec2& point, int row, int column) {
    const ArcMotion motion = drive.motion(drive.wheels(row, column));
    return drive.is_allowed(motion) ? outline.time_to_collision_s(point, motion) : -1;
  });
}

TEST_CASE("cell times are the minimum over all points of the cell, for a thin hull") {
  // The hull is thinner than a cell: it crosses cells without containing any of their corners.
  const DifferentialDrive drive;
  const ConvexPolygon hull{{{-0.3, -0.004}, {0.31, -0.004}, {0.31, 0.004}, {-0.3, 0.004}}};
  const Hull outline(hull);
  const CellTimes times = hull_cell_times(drive, hull, 0.05, kHorizon_s);
  Rng rng(4);
  compare_with_points(times, rng, [&](const Vec2& point, int row, int column) {
    const ArcMotion motion = drive.motion(drive.wheels(row, column));
    return drive.is_allowed(motion) ? outline.time_to_collision_s(point, motion) : -1;
  });
}

TEST_CASE("cell times are the minimum over all points of the cell, for discs") {
  const double radius_m = 0.09, speed_mps = 2;
  const CellTimes times = disc_cell_times(radius_m, speed_mps, 0.08, kHorizon_s);
  Rng rng(5);
  compare_with_points(times, rng, [&](const Vec2& point, int row, int column) {
    const Vec2 velocity = grid_velocity(row, column, speed_mps);
    return is_within_speed(velocity, speed_mps) ? disc_time_to_collision_s(point, radius_m, velocity) : -1;
  });
}

TEST_CASE("a disc's time to collision agrees with dense time steps") {
  Rng rng(6);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 point = random_point(rng, 1), velocity = random_point(rng, 2);
    const double radius_m = rng.uniform(0.05, 0.3);
    const double time_s = disc_time_to_collision_s(point, radius_m, velocity);
    CAPTURE(i, time_s);
    for (double t = 0; t < std::min(time_s, 1.0); t += 1e-3)
      REQUIRE((point - t * velocity).norm() > radius_m - 1e-9);
    if (time_s > 1) continue;
    ++hits;
    if (time_s > 0) REQUIRE((point - time_s * velocity).norm() == Approx(radius_m));
    if (time_s == 0) REQUIRE(point.norm() <= radius_m);
  }
  CHECK(hits > 150);
}

TEST_CASE("table times are the minimum over the cells of all points, and never later than exact times") {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(seed);
  Rng rng(seed);
  const DifferentialDrive drive;
  const ConvexPolygon hull = random_hull(rng, 0.25);
  const Hull outline(hull);
  const CellTimes cells = hull_cell_times(drive, hull, 0.06, kHorizon_s);
  const auto horizon_s = static_cast<float>(kHorizon_s);
  CollisionTable tables[] = {{cells, Quantiser::uniform(horizon_s)},
                             {cells, Quantiser::lloyd_max(cells.times_s, horizon_s)}};
  for (int scene = 0; scene < 6; ++scene) {
    std::vector<Vec2> points;
    const std::size_t count = rng.below(60);
    while (points.size() < count) points.push_back(random_point(rng, 1.2));
    if (scene == 0) points.emplace_back(std::nan(""), 0);
    for (CollisionTable& table : tables) {
      VelocityTimes times;
      std::vector<Vec2> exact;
      table.minimum(points, kAll, times, exact);
      std::size_t on_hull = 0;
      for (const Vec2& point : points) {
        const auto cell = table.grid().cell_of(point);
        on_hull += cell && cells.touches_hull[*cell] ? 1 : 0;
      }
      CHECK(exact.size() == on_hull);
      for_each_velocity(kAll, [&](int row, int column, std::size_t slot) {
        const ArcMotion motion = drive.motion(drive.wheels(row, column));
        if (!drive.is_allowed(motion)) return;
        float stored = horizon_s;
        double exact_s = kHorizon_s;
        for (const Vec2& point : points) {
          const auto cell = table.grid().cell_of(point);
          if (cell && cells.touches_hull[*cell]) continue;
          if (cell) stored = std::min(stored, table.time_s(*cell, slot).value());
          if (point.allFinite()) exact_s = std::min(exact_s, outline.time_to_collision_s(point, motion));
        }
        REQUIRE(times[slot] == stored);
        REQUIRE(static_cast<double>(stored) <= exact_s);
      });
    }
  }
}

TEST_CASE("a table of part of the grid has the same entries as the whole table") {
  const DifferentialDrive drive;
  const ConvexPolygon hull{{{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}}};
  CollisionTable table(hull_cell_times(drive, hull, 0.06, kHorizon_s), Quantiser::uniform(kHorizon_s));
  Rng rng(8);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec2> points, exact;
    for (int k = 0; k < 20; ++k) points.push_back(random_point(rng, 0.7));
    VelocityTimes all, part;
    table.minimum(points, kAll, all, exact);
    const auto index = [&] { return static_cast<int>(rng.below(kGridSide)); };
    const int a = index(), b = index(), c = index(), d = index();
    const GridWindow window{{std::min(a, b), std::max(a, b)}, {std::min(c, d), std::max(c, d)}};
    table.minimum(points, window, part, exact);
    for_each_velocity(window, [&](int, int, std::size_t slot) { REQUIRE(part[slot] == all[slot]); });
  }
}

TEST_CASE("grids that are too large or have no cells are refused") {
  CHECK_THROWS_AS(disc_cell_times(0.1, 2, 0, 1), std::invalid_argument);
  CHECK_THROWS_AS(disc_cell_times(0.1, 2, 1e-4, 1), std::invalid_argument);
  CHECK_THROWS_AS(disc_cell_times(0.1, 0, 0.1, 1), std::invalid_argument);
  const ConvexPolygon hull{{{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}}};
  CHECK_THROWS_AS(hull_cell_times({}, hull, 0.03, 0), std::invalid_argument);
  CHECK_THROWS_AS(hull_cell_times({.wheel_base_m = 0}, hull, 0.03, 1), std::invalid_argument);
}

}  // namespace sidestep::cell_times_test
