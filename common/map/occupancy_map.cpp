// SPDX-License-Identifier: Apache-2.0
#include "common/map/occupancy_map.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "common/collision/sweep.hpp"
#include "common/geometry/convex_polygon.hpp"

namespace sidestep {
namespace {

/// Widens candidate ranges so that rounding excludes no candidate; much larger than the rounding errors of
/// coordinates.
constexpr double kSlack_m = 1e-6;

/// The bounding box of the part of a path that is within `reach_m` of a row, widened by the slack.
Box part_near_row(const Segment& path, double row_low_m, double row_high_m, double reach_m) {
  const double low_m = row_low_m - reach_m - kSlack_m, high_m = row_high_m + reach_m + kSlack_m;
  const Vec2 along = path.to_m - path.from_m;
  double begin = 0, end = 1;
  if (along.y() != 0) {
    const auto [first, last] =
        std::minmax({(low_m - path.from_m.y()) / along.y(), (high_m - path.from_m.y()) / along.y()});
    begin = std::clamp(first, 0.0, 1.0);
    end = std::clamp(last, 0.0, 1.0);
  }
  const double a_m = path.from_m.x() + begin * along.x(), b_m = path.from_m.x() + end * along.x();
  return {{std::min(a_m, b_m) - reach_m - kSlack_m, row_low_m},
          {std::max(a_m, b_m) + reach_m + kSlack_m, row_high_m}};
}

}  // namespace

OccupancyMap::OccupancyMap(const MapGrid& grid, BitGrid blocked) : grid_(grid), blocked_(std::move(blocked)) {
  check(grid);
  if (blocked_.columns() != grid.columns || blocked_.rows() != grid.rows) {
    throw std::invalid_argument(fmt::format("a map of {} x {} cells was given {} x {} bits", grid.columns,
                                            grid.rows, blocked_.columns(), blocked_.rows()));
  }
}

double OccupancyMap::distance_m(const Vec2& p, double max_m) const {
  if (!p.allFinite()) throw std::invalid_argument("the position of a distance query is not finite");
  if (!(max_m >= 0)) throw std::invalid_argument("the maximum distance of a query is negative or NaN");
  double best_m = std::min(max_m, -signed_distance(p, extent()));
  if (best_m <= 0) return 0;
  const Cell at = cell_at(p);
  // Visits rows by increasing distance, and searches each only up to the best distance so far.
  const auto search = [&](int row, double row_distance_m) {
    const double reach_m = std::sqrt(best_m * best_m - row_distance_m * row_distance_m);
    const int reach = static_cast<int>(reach_m / grid_.resolution_m) + 1;
    const int end = std::min(grid_.columns, at.column + reach + 1), last = std::max(0, at.column - reach);
    if (const int right = blocked_.find_set(at.column, end, row); right < end)
      best_m = std::min(best_m, std::hypot(std::max(0.0, grid_.x_m(right) - p.x()), row_distance_m));
    if (const int left = blocked_.find_last_set(at.column, last, row); left >= last)
      best_m = std::min(best_m, std::hypot(std::max(0.0, p.x() - grid_.x_m(left + 1)), row_distance_m));
  };
  search(at.row, 0);
  for (int steps = 1; best_m > 0; ++steps) {
    const int above = at.row + steps, below = at.row - steps;
    const double above_m = above < grid_.rows ? grid_.y_m(above) - p.y() : best_m;
    if (above_m < best_m) search(above, above_m);
    const double below_m = below >= 0 ? p.y() - grid_.y_m(below + 1) : best_m;
    if (below_m < best_m) search(below, below_m);
    if (above_m >= best_m && below_m >= best_m) break;
  }
  return best_m;
}

bool OccupancyMap::touches(const Vec2& from, const Vec2& to, double radius) const {
  const Sweep sweep(from, to, radius);
  const Box bounds = sweep.bounds(), map = extent();
  const bool is_inside =
      (bounds.min_m.array() > map.min_m.array()).all() && (bounds.max_m.array() < map.max_m.array()).all();
  if (!is_inside) return true;
  const Segment path = sweep.segment();
  const CellRange rows = grid_.cells_intersecting(bounds);
  for (int row = rows.first.row; row <= rows.last.row; ++row) {
    const Box part = part_near_row(path, grid_.y_m(row), grid_.y_m(row + 1), radius);
    const int end_column = std::min(grid_.cell_at(part.max_m).column + 1, grid_.columns);
    int end = std::max(grid_.cell_at(part.min_m).column, 0);
    while (true) {
      const int begin = blocked_.find_set(end, end_column, row);
      if (begin >= end_column) break;
      end = blocked_.find_clear(begin, end_column, row);
      if (squared_distance(path, corners_of(box_of(begin, end, row, row + 1))) <= radius * radius)
        return true;
    }
  }
  return false;
}

void OccupancyMap::check_region(const Box& region) const {
  if (!region.min_m.allFinite() || !region.max_m.allFinite() ||
      (region.min_m.array() > region.max_m.array()).any())
    throw std::invalid_argument("a region of a map is not finite, or its minimum exceeds its maximum");
}

}  // namespace sidestep
