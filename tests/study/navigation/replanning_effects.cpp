// SPDX-License-Identifier: Apache-2.0
#include "tests/study/navigation/replanning_effects.hpp"

#include <algorithm>
#include <numbers>

#include "agents/planning/grids/navigation/descent.hpp"
#include "common/geometry/segment.hpp"
#include "common/random/rng.hpp"

namespace sidestep {
namespace {

std::size_t count_changed(const EStar& a, const EStar& b) {
  std::size_t count = 0;
  for (GridCell cell = 0; cell < a.layout().size(); ++cell) count += a.value(cell) != b.value(cell);
  return count;
}

/// The largest distance of a path's vertices from the straight line, in cells.
double largest_offset(const std::vector<Vec2>& path_m, const Segment& straight, double resolution_m) {
  double largest2 = 0;
  for (const Vec2& at : path_m) largest2 = std::max(largest2, squared_distance(at, straight));
  return std::sqrt(largest2) / resolution_m;
}

struct WallEffects {
  std::vector<double> changed, expanded_by_insertion, expanded_by_removal, offsets;
};

double median_of(std::vector<double>& values) { return plot_point(0, values).median; }

}  // namespace

StudyTable replanning_effects(std::uint32_t side, int walls, std::uint64_t seed) {
  StudyTable table;
  table.name = "replanning";
  table.columns = {"distance_cells",      "changed_cells",     "expanded_by_insertion",
                   "expanded_by_removal", "path_offset_cells", "equals_fresh"};
  table.plots = {{.title = fmt::format("{} x {} cells", side, side),
                  .x_label = "distance of the wall from the goal [cells]",
                  .y_label = "cells",
                  .has_log_x = true}};
  for (const char* line : {"changed", "expanded, wall appears", "expanded, wall disappears"})
    table.plots[0].lines.push_back({line, {}});
  const CostGrid grid({.columns = side, .rows = side});
  const GridLayout& layout = grid.layout();
  const Vec2 goal_m = layout.centre_of(layout.cell(side / 2, side / 2));
  EStar field(grid), fresh(grid);
  field.set_goal(goal_m);
  field.propagate();
  const EStar before = field;
  Rng rng(seed);
  for (const std::uint32_t distance : {5u, 20u, 50u, 100u, 200u}) {
    if (distance > 2 * side / 5) continue;
    WallEffects effects;
    bool is_equal = true;
    for (int i = 0; i < walls; ++i) {
      const double angle_rad = rng.uniform(-std::numbers::pi, std::numbers::pi);
      const Vec2 along(std::cos(angle_rad), std::sin(angle_rad));
      const Vec2 across = std::abs(along.x()) > std::abs(along.y()) ? Vec2(0, 1) : Vec2(1, 0);
      std::vector<GridCell> wall;
      for (int k = -5; k < 5; ++k)
        wall.push_back(*layout.cell_at(goal_m + layout.resolution_m * (distance * along + k * across)));
      const auto replan = [&](float cost) {
        const std::uint64_t expansions = field.expansions();
        for (const GridCell cell : wall) field.set_cost(cell, cost);
        field.propagate();
        return static_cast<double>(field.expansions() - expansions);
      };
      effects.expanded_by_insertion.push_back(replan(kBlocked));
      effects.changed.push_back(static_cast<double>(count_changed(field, before)));
      for (const GridCell cell : wall) fresh.set_cost(cell, kBlocked);
      fresh.set_goal(goal_m);
      fresh.propagate();
      for (const GridCell cell : wall) fresh.set_cost(cell, 1);
      is_equal = is_equal && count_changed(field, fresh) == 0;
      const Vec2 robot_m = goal_m + layout.resolution_m * (0.45 * side) * along;
      std::vector<Vec2> path_m;
      if (trace(field, robot_m, path_m))
        effects.offsets.push_back(largest_offset(path_m, {robot_m, goal_m}, layout.resolution_m));
      effects.expanded_by_removal.push_back(replan(1));
      is_equal = is_equal && count_changed(field, before) == 0;
    }
    std::vector<double>* const lines[] = {&effects.changed, &effects.expanded_by_insertion,
                                          &effects.expanded_by_removal};
    for (std::size_t i = 0; i < std::size(lines); ++i)
      table.plots[0].lines[i].points.push_back(plot_point(distance, *lines[i]));
    table.rows.push_back(cells(distance, median_of(effects.changed), median_of(effects.expanded_by_insertion),
                               median_of(effects.expanded_by_removal),
                               fmt::format("{:.2f}", median_of(effects.offsets)), is_equal));
  }
  return table;
}

}  // namespace sidestep
