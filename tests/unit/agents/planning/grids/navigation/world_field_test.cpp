// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/world_field.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_shape.hpp"

namespace sidestep::world_field_test {

TEST_CASE("cells cover the disc's positions and leave margins narrower than a cell") {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Rng rng(seed);
    const double length_m = rng.uniform(0.05, 40), width_m = rng.uniform(0.05, 40);
    const Field floor{length_m, width_m};
    const double radius_m = rng.chance(0.1) ? 0 : rng.uniform(0, 0.3);
    CAPTURE(seed, length_m, width_m, radius_m);
    const auto layout = layout_of(floor, radius_m, {});
    const double x_m = length_m - 2 * radius_m, y_m = width_m - 2 * radius_m;
    if (!layout) {
      REQUIRE((x_m <= 0 || y_m <= 0 || std::max(x_m, y_m) / std::min(x_m, y_m) > 20'000));
      continue;
    }
    check(*layout);
    REQUIRE(layout->size() <= kMaxFieldCells);
    const double cell_m = layout->resolution_m;
    const Vec2 first = layout->centre_of(0),
               last = layout->centre_of(static_cast<GridCell>(layout->size() - 1));
    REQUIRE((first + last).norm() < 1e-9);
    const Vec2 margin_m = Vec2(x_m, y_m) / 2 - last - Vec2(cell_m, cell_m) / 2;
    REQUIRE(margin_m.minCoeff() > -1e-9);
    REQUIRE(margin_m.maxCoeff() < cell_m / 2);
    const bool is_small = x_m * y_m < static_cast<double>(kMaxFieldCells) * kFieldCell_m * kFieldCell_m;
    if (is_small && std::min(x_m, y_m) > kFieldCell_m) REQUIRE(cell_m == Approx(kFieldCell_m).epsilon(1e-3));
  }
}

TEST_CASE("floors whose length is a multiple of the cell size are covered completely") {
  const auto layout = layout_of({10, 7}, 0.1, {});
  REQUIRE(layout);
  CHECK(layout->columns == 196);
  CHECK(layout->rows == 136);
  CHECK(layout->resolution_m == Approx(0.05));
}

TEST_CASE("navigation functions reject invalid settings, floors and goals") {
  CHECK_THROWS_AS(layout_of({10, 10}, 0.1, {.contact_cost = 1e7}), std::invalid_argument);
  CHECK_THROWS_AS(layout_of({10, 10}, -0.1, {}), std::invalid_argument);
  CHECK_THROWS_AS(layout_of({std::nan(""), 10}, 0.1, {}), std::invalid_argument);
  WorldField field(*layout_of({1, 1}, 0.1, {}), {1, 1}, 0.1);
  CHECK_THROWS_AS(field.set_goal({2, 0}), std::invalid_argument);
}

/// Slow reference: computes the costs and values of all cells from scratch, with all obstacles.
EStar from_scratch(const GridLayout& layout, const ObstacleWorld& world, double radius_m,
                   const WorldFieldSettings& settings, const Vec2& goal_m) {
  CostGrid grid(layout);
  for (GridCell cell = 0; cell < layout.size(); ++cell) {
    const Vec2 centre = layout.centre_of(cell), half = Vec2(0.5, 0.5) * layout.resolution_m;
    double nearest_m = 1e9;
    bool is_blocked = false;
    for (const ObstacleId id : world.obstacles()) {
      nearest_m = std::min(nearest_m, signed_distance(centre, world.shape(id)));
      // The distance from the shape to the cell's edges, or 0 if the shape lies within the cell.
      const std::array<Vec2, 4> corners = corners_of(Box{centre - half, centre + half});
      for (std::size_t i = 0; i < 4; ++i)
        is_blocked |= squared_distance(Segment{corners[i], corners[(i + 1) % 4]}, world.shape(id)) <=
                      (radius_m + 1e-9) * (radius_m + 1e-9);
    }
    const double lack = std::max(0.0, 1 - (nearest_m - radius_m) / settings.clearance_m);
    grid.set_cost(cell, is_blocked ? kBlocked : static_cast<float>(1 + settings.contact_cost * lack * lack));
  }
  EStar field(grid, {.kernel = settings.kernel});
  field.set_goal(goal_m);
  field.propagate();
  return field;
}

TEST_CASE("clearance costs and values follow moving obstacles") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Rng rng(seed);
    const Field floor{3.4, 2.4};
    const double radius_m = rng.uniform(0.05, 0.2);
    const WorldFieldSettings settings{.clearance_m = rng.uniform(0.1, 0.5),
                                      .contact_cost = rng.uniform(1, 20)};
    ObstacleWorld world;
    for (int i = 0; i < 6; ++i) world.add(moved(random_shape(rng), {-1.7, -1.2}));
    const auto layout = layout_of(floor, radius_m, settings);
    REQUIRE(layout);
    WorldField field(*layout, floor, radius_m, settings);
    const Vec2 goal_m = layout->centre_of(static_cast<GridCell>(rng.below(layout->size())));
    field.set_goal(goal_m);
    for (int i = 0; i < 8; ++i) {
      CAPTURE(seed, i);
      const double y = rng.uniform(-0.4, 0.4), x = rng.uniform(-0.4, 0.4);
      world.move(world.obstacle(rng.below(world.size())), {x, y});
      if (i == 5) world.remove(world.obstacle(0));
      field.update(world);
      const auto from = static_cast<GridCell>(rng.below(layout->size()));
      const bool is_reached = field.reach(from);
      const EStar expected = from_scratch(*layout, world, radius_m, settings, goal_m);
      REQUIRE(is_reached == (expected.value(from) < kBlocked));
      for (GridCell cell = 0; cell < layout->size(); ++cell) {
        REQUIRE(field.values().cost(cell) == expected.cost(cell));
        if (expected.value(cell) <= expected.value(from) + 4)
          REQUIRE(field.values().value(cell) == expected.value(cell));
      }
    }
  }
}

}  // namespace sidestep::world_field_test
