// SPDX-License-Identifier: Apache-2.0
#include "tests/study/navigation/kernel_errors.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "agents/planning/grids/navigation/descent.hpp"
#include "common/random/rng.hpp"

namespace sidestep {
namespace {

struct KernelVariant {
  const char* name;
  EStarSettings settings;
};
constexpr KernelVariant kKernelVariants[] = {{"NF1", {GridKernel::kNf1, 0}},
                                             {"alpha", {GridKernel::kAlpha, 0}},
                                             {"LSM", {GridKernel::kLsm, 0}},
                                             {"LSM + exact 20", {GridKernel::kLsm, 20}},
                                             {"second order", {GridKernel::kSecondOrderLsm, 0}},
                                             {"second order + exact 20", {GridKernel::kSecondOrderLsm, 20}},
                                             {"line of sight", {GridKernel::kLineOfSight, 0}}};
constexpr int kStep_deg = 3, kDirections = 90 / kStep_deg + 1;

struct Errors {
  double sum = 0, largest = 0;
  std::size_t count = 0;
  void add(double error) {
    sum += error;
    largest = std::max(largest, std::abs(error));
    ++count;
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
};

EStar propagated(const CostGrid& grid, const Vec2& goal_m, const EStarSettings& settings) {
  EStar field(grid, settings);
  field.set_goal(goal_m);
  field.propagate();
  return field;
}

std::array<Errors, kDirections> errors_of(const EStar& field) {
  const GridLayout& layout = field.layout();
  std::array<Errors, kDirections> errors;
  for (GridCell cell = 0; cell < layout.size(); ++cell) {
    const Vec2 from_goal = (layout.centre_of(cell) - field.goal_m()) / layout.resolution_m;
    if (from_goal.norm() < layout.columns / 4.0 || from_goal.x() < 0 || from_goal.y() < 0) continue;
    const double angle_deg = std::atan2(from_goal.y(), from_goal.x()) * 180 / std::numbers::pi;
    errors[static_cast<std::size_t>(angle_deg / kStep_deg + 0.5)].add(static_cast<double>(field.value(cell)) -
                                                                      from_goal.norm());
  }
  return errors;
}

double path_cells(const std::vector<Vec2>& path_m, double resolution_m) {
  double length_m = 0;
  for (std::size_t i = 1; i < path_m.size(); ++i) length_m += (path_m[i] - path_m[i - 1]).norm();
  return length_m / resolution_m;
}

}  // namespace

StudyTable errors_by_direction(std::uint32_t side) {
  StudyTable table;
  table.name = "directions";
  table.columns = {"kernel", "direction_deg", "mean_error_cells", "largest_error_cells"};
  table.plots = {
      {.title = "all kernels", .x_label = "direction [deg]", .y_label = "error [cells]", .min_y = -60},
      {.title = "fast marching", .x_label = "direction [deg]", .y_label = "error [cells]", .min_y = -0.4}};
  const CostGrid grid({.columns = side, .rows = side});
  const Vec2 goal_m = grid.layout().centre_of(grid.layout().cell(side / 2, side / 2));
  for (const KernelVariant& variant : kKernelVariants) {
    const auto errors = errors_of(propagated(grid, goal_m, variant.settings));
    PlotLine line{variant.name, {}};
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const int direction_deg = kStep_deg * static_cast<int>(i);
      table.rows.push_back(cells(variant.name, direction_deg, fmt::format("{:.3f}", errors[i].mean()),
                                 fmt::format("{:.3f}", errors[i].largest)));
      line.points.push_back(plot_point(direction_deg, errors[i].mean()));
    }
    if (variant.settings.exact_radius_cells == 0) table.plots[0].lines.push_back(line);
    if (variant.settings.kernel != GridKernel::kNf1 && variant.settings.kernel != GridKernel::kAlpha)
      table.plots[1].lines.push_back(line);
  }
  return table;
}

StudyTable errors_among_obstacles(std::uint32_t side, int grids, std::uint64_t seed) {
  StudyTable table;
  table.name = "obstacles";
  table.columns = {"kernel", "blocked_percent", "mean_error_cells", "largest_error_cells", "path_over_exact"};
  table.plots = {{.title = fmt::format("{} x {} cells", side, side),
                  .x_label = "blocked cells [%]",
                  .y_label = "mean error [cells]"}};
  constexpr int kPaths = 50;
  for (const KernelVariant& variant : kKernelVariants) {
    PlotLine line{variant.name, {}};
    for (const int percent : {0, 5, 10, 20}) {
      Errors errors, ratios;
      for (int i = 0; i < grids; ++i) {
        Rng rng(seed + static_cast<std::uint64_t>(i));
        CostGrid grid({.columns = side, .rows = side});
        const GridCell goal = grid.layout().cell(side / 10, side / 10);
        const Vec2 goal_m = grid.layout().centre_of(goal);
        LineOfSightDistances exact(grid.layout());
        for (GridCell cell = 0; cell < grid.layout().size(); ++cell) {
          if (rng.chance(0.01 * percent) && cell != goal) grid.block(cell);
          exact.set_open(cell, !grid.is_blocked(cell));
        }
        exact.compute(grid.layout().in_cells(goal_m));
        const EStar field = propagated(grid, goal_m, variant.settings);
        for (GridCell cell = 0; cell < grid.layout().size(); ++cell)
          if (field.value(cell) < kBlocked)
            errors.add(
                std::abs(static_cast<double>(field.value(cell)) - static_cast<double>(exact.length(cell))));
        std::vector<Vec2> path_m;
        for (int k = 0; k < kPaths; ++k) {
          const auto cell = static_cast<GridCell>(rng.below(grid.layout().size()));
          if (exact.length(cell) < 1 || !trace(field, grid.layout().centre_of(cell), path_m)) continue;
          ratios.add(path_cells(path_m, grid.layout().resolution_m) /
                     static_cast<double>(exact.length(cell)));
        }
      }
      table.rows.push_back(cells(variant.name, percent, fmt::format("{:.3f}", errors.mean()),
                                 fmt::format("{:.2f}", errors.largest),
                                 fmt::format("{:.4f}", ratios.mean())));
      line.points.push_back(plot_point(percent, errors.mean()));
    }
    table.plots[0].lines.push_back(line);
  }
  return table;
}

}  // namespace sidestep
