// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/blocked_cells.hpp"
#include "agents/planning/grids/navigation/risk_layer.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_grid.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_shape.hpp"

namespace sidestep::costs_test {

TEST_CASE("discs at free cells never touch the shape, and no cell far away is blocked") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    CostGrid grid({.columns = 30, .rows = 20, .resolution_m = 0.1});
    const GridLayout& layout = grid.layout();
    const Shape shape = random_shape(rng);
    const double radius_m = rng.chance(0.2) ? 0 : rng.uniform(0, 0.4);
    block_shape(grid, shape, radius_m);
    for (int i = 0; i < 200; ++i) {
      const Vec2 at = random_position(rng, layout);
      CAPTURE(at.transpose(), radius_m);
      if (!grid.is_blocked(*layout.cell_at(at))) REQUIRE(signed_distance(at, shape) > radius_m);
    }
    const double diagonal_m = 0.1 * std::sqrt(2.0);
    for (GridCell cell = 0; cell < layout.size(); ++cell)
      if (signed_distance(layout.centre_of(cell), shape) > radius_m + diagonal_m)
        REQUIRE_FALSE(grid.is_blocked(cell));
  }
}

TEST_CASE("occupied cells block the same cells as boxes of the same size") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    CostGrid grid({.columns = 26, .rows = 17, .resolution_m = 0.05, .origin_m = {1, -1}});
    CostGrid expected = grid;
    const GridLayout& layout = grid.layout();
    std::vector<std::uint8_t> occupied(layout.size());
    const double radius_m = rng.chance(0.2) ? 0 : rng.uniform(0, 0.3);
    const Vec2 half = Vec2(0.5, 0.5) * layout.resolution_m;
    for (GridCell cell = 0; cell < layout.size(); ++cell) {
      if (!rng.chance(0.02)) continue;
      occupied[cell] = 1;
      const Vec2 centre = layout.centre_of(cell);
      block_shape(expected, Box{centre - half, centre + half}, radius_m);
    }
    block_occupied(grid, occupied, radius_m);
    for (GridCell cell = 0; cell < layout.size(); ++cell)
      REQUIRE(grid.is_blocked(cell) == expected.is_blocked(cell));
  }
}

TEST_CASE("shapes and bitmaps outside the grid block no cells, and invalid shapes and bitmaps are refused") {
  CostGrid grid({.columns = 5, .rows = 5});
  block_shape(grid, Circle{{10, 10}, 1}, 0.5);
  block_shape(grid, Circle{{-10, 0.2}, 1}, 0.5);
  for (GridCell cell = 0; cell < 25; ++cell) CHECK_FALSE(grid.is_blocked(cell));
  const std::vector<std::uint8_t> wrong_size(24);
  CHECK_THROWS_AS(block_occupied(grid, wrong_size, 0.1), std::invalid_argument);
  CHECK_THROWS_AS(block_shape(grid, Circle{{0, 0}, -1}, 0.1), std::invalid_argument);
  CHECK_THROWS_AS(block_shape(grid, Circle{{0, 0}, 1}, -0.1), std::invalid_argument);
}

/// Slow reference for the risk: samples times when the disc covers the cell and keeps the best match with the
/// arrival.
double sampled_risk(const MovingDisc& disc, const RiskSettings& settings, const Vec2& robot_m,
                    const Vec2& at) {
  double risk = 0;
  const double arrival_s = (at - robot_m).norm() / settings.robot_speed_mps;
  for (int i = 0; i <= 20'000; ++i) {
    const double time_s = RiskLayer::kHorizon_s * i / 20'000;
    const Vec2 centre = disc.position_m + time_s * disc.velocity_mps;
    if ((centre - at).norm() > disc.radius_m + RiskLayer::kRobotRadius_m) continue;
    const double off = (time_s - arrival_s) / RiskLayer::kSpread_s;
    risk = std::max(risk, std::exp(-off * off / 2));
  }
  return risk;
}

TEST_CASE("risk is highest where the robot and a person meet") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const CostGrid grid({.columns = 20, .rows = 20, .resolution_m = 0.2});
    const RiskSettings settings;
    RiskLayer risks(grid, settings);
    const double vx = rng.uniform(-1, 1), vy = rng.uniform(-1, 1);
    const MovingDisc disc{random_position(rng, grid.layout()), seed == 1 ? Vec2(0, 0) : Vec2(vx, vy)};
    const Vec2 robot = random_position(rng, grid.layout());
    risks.add(disc, robot);
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell) {
      const double risk = sampled_risk(disc, settings, robot, grid.layout().centre_of(cell));
      REQUIRE(risks.cost(cell) == Approx(1 + settings.cost * risk).margin(0.05));
    }
  }
}

TEST_CASE("removing discs restores the costs and the field exactly") {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const CostGrid grid = random_grid(rng, 50, 40, 0.1);
    const Vec2 goal = random_position(rng, grid.layout()), robot = random_position(rng, grid.layout());
    const EStar before = propagated(grid, goal);
    EStar field = before;
    RiskLayer risks(grid);
    const auto apply = [&] {
      for (const GridCell cell : risks.changed()) field.set_cost(cell, risks.cost(cell));
      field.propagate();
    };
    std::vector<std::uint32_t> ids;
    for (int i = 0; i < 5; ++i) {
      const Vec2 from = random_position(rng, grid.layout()), to = random_position(rng, grid.layout());
      ids.push_back(risks.add({from, (to - from) / 4}, robot));
      apply();
    }
    rng.shuffle(ids);
    for (const std::uint32_t id : ids) {
      risks.remove(id);
      apply();
    }
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell) REQUIRE(risks.cost(cell) == grid.cost(cell));
    REQUIRE(count_differences(field, before) == 0);
    CHECK_THROWS_AS(risks.remove(ids[0]), std::invalid_argument);
  }
}

}  // namespace sidestep::costs_test
