// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/world_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr double kMaxSide = 32'000;  // maximum number of cells per side, as in GridLayout

void check_settings(const WorldFieldSettings& settings) {
  const auto is_valid = [](double x, double max) { return x >= 0 && x <= max; };
  constexpr double kMaxLength_m = 1e15;
  if (!is_valid(settings.clearance_m, kMaxLength_m) || !is_valid(settings.contact_cost, kMaxCost - 1))
    throw std::invalid_argument("the settings of a navigation function must be positive and finite");
}

/// The index of the column or row that contains a coordinate, clamped to the grid.
std::uint32_t clipped_index(double in_cells, std::uint32_t count) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(in_cells), 0.0, static_cast<double>(count - 1)));
}

}  // namespace

std::optional<GridLayout> layout_of(const Field& floor, double radius_m, const WorldFieldSettings& settings) {
  check_settings(settings);
  const double x_m = floor.length_m - 2 * radius_m, y_m = floor.width_m - 2 * radius_m;
  if (!std::isfinite(x_m) || !std::isfinite(y_m) || !(radius_m >= 0))
    throw std::invalid_argument("a floor and a disc need a finite size");
  if (!(x_m > 0) || !(y_m > 0)) return std::nullopt;
  const auto max_cells = static_cast<double>(kMaxFieldCells);
  const double wanted_m =
      std::max({kFieldCell_m, std::sqrt(x_m * y_m / max_cells), x_m / kMaxSide, y_m / kMaxSide});
  const double cell_m = std::min({wanted_m, x_m, y_m});
  // If rounding adds a tiny part of a cell, all cells are shrunk accordingly.
  const double columns = std::floor(x_m / cell_m + 1e-6), rows = std::floor(y_m / cell_m + 1e-6);
  if (columns > kMaxSide || rows > kMaxSide || columns * rows > max_cells) return std::nullopt;
  const double side_m = std::min({cell_m, x_m / columns, y_m / rows});
  return GridLayout{.columns = static_cast<std::uint32_t>(columns),
                    .rows = static_cast<std::uint32_t>(rows),
                    .resolution_m = side_m,
                    .origin_m = Vec2(-columns, -rows) * (side_m / 2)};
}

WorldField::WorldField(const GridLayout& layout, const Field& floor, double radius_m,
                       const WorldFieldSettings& settings)
    : floor_(floor),
      radius_m_(radius_m),
      settings_(settings),
      obstacles_(layout, radius_m),
      values_(CostGrid(layout), {.kernel = settings.kernel}),
      updated_at_(layout.size()) {
  check_settings(settings);
}

bool WorldField::is_for(const Field& floor, double radius_m) const {
  return floor.length_m == floor_.length_m && floor.width_m == floor_.width_m && radius_m == radius_m_;
}

void WorldField::update(const ObstacleWorld& world) {
  obstacles_.update(world);
  ++updates_;
  for (const GridCell cell : obstacles_.changed_cells()) update_cost(world, cell);
  if (!keeps_clear()) return;
  for (const Box& bounds_m : obstacles_.changed_bounds()) update_costs_near(world, bounds_m);
}

/// Does nothing if the cell was already updated for this world.
void WorldField::update_cost(const ObstacleWorld& world, GridCell cell) {
  if (updated_at_[cell] == updates_) return;
  updated_at_[cell] = updates_;
  values_.set_cost(cell, cost_of(world, cell));
}

float WorldField::cost_of(const ObstacleWorld& world, GridCell cell) const {
  if (obstacles_.is_blocked(cell)) return kBlocked;
  if (!keeps_clear()) return 1;
  const double clearance_m = world.nearest(values_.layout().centre_of(cell)).distance_m - radius_m_;
  const double lack = std::max(1 - clearance_m / settings_.clearance_m, 0.0);
  return static_cast<float>(1 + settings_.contact_cost * lack * lack);
}

void WorldField::update_costs_near(const ObstacleWorld& world, const Box& bounds_m) {
  const GridLayout& layout = values_.layout();
  const Box reach = inflated(bounds_m, radius_m_ + settings_.clearance_m);
  const Vec2 first = layout.in_cells(reach.min_m), last = layout.in_cells(reach.max_m);
  if (last.x() < 0 || last.y() < 0 || first.x() > layout.columns || first.y() > layout.rows) return;
  const std::uint32_t last_row = clipped_index(last.y(), layout.rows),
                      last_column = clipped_index(last.x(), layout.columns);
  for (std::uint32_t row = clipped_index(first.y(), layout.rows); row <= last_row; ++row)
    for (std::uint32_t column = clipped_index(first.x(), layout.columns); column <= last_column; ++column)
      update_cost(world, layout.cell(column, row));
}

void WorldField::set_goal(const Vec2& goal_m) {
  if (has_goal_ && goal_m == values_.goal_m()) return;
  values_.set_goal(goal_m);
  has_goal_ = true;
}

bool WorldField::reach(GridCell cell) {
  // The values of adjacent cells differ by up to the cost of a cell. A path descends, so all cells between
  // whose centres it interpolates are at most four steps higher than the first cell.
  const auto max_cell_cost = static_cast<float>(1 + (keeps_clear() ? settings_.contact_cost : 0));
  values_.propagate_until(cell, 4 * max_cell_cost);
  return !values_.is_blocked(cell) && values_.value(cell) < kBlocked;
}

}  // namespace sidestep
