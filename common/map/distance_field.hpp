// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// The distances of all cells of a map to the nearest blocked cell, two bytes per cell (8 MB for 2,000 x
/// 2,000 cells, and twice that during computation). Const functions are thread-safe and do not allocate. The
/// outside of the map counts as blocked in all bounds.
class DistanceField {
 public:
  explicit DistanceField(const OccupancyMap& map);

  const MapGrid& grid() const { return grid_; }

  /// A lower bound of the distance from a point to the nearest blocked cell or the outside. It is 0 inside a
  /// blocked cell, outside the map and for points that are not finite. For distances up to 2,047 cells it is
  /// at most 1.5 cells below the true distance.
  double lower_bound_m(const Vec2& p) const {
    const Vec2 offset = p - grid_.origin_m, left = size_m_ - offset;
    if (!(offset.x() > 0 && offset.y() > 0 && left.x() > 0 && left.y() > 0)) return 0;
    const int column = std::min(static_cast<int>(offset.x() * cells_per_m_), grid_.columns - 1);
    const int row = std::min(static_cast<int>(offset.y() * cells_per_m_), grid_.rows - 1);
    // The bound holds for any cell, so it does not matter if rounding selects a neighbour of p's cell.
    const Vec2 from_centre(offset.x() - (column + 0.5) * grid_.resolution_m,
                           offset.y() - (row + 0.5) * grid_.resolution_m);
    const double bound_m = stored(column, row) * m_per_step_ - margin_m_ - from_centre.norm();
    const double border_m = std::min(std::min(offset.x(), offset.y()), std::min(left.x(), left.y()));
    return std::max(0.0, std::min(bound_m, border_m - kRounding_m));
  }

  /// Whether the bounds prove that a disc that moves straight from one position to another touches neither a
  /// blocked cell nor the outside. Conservative: never falsely true. False for non-finite numbers and
  /// negative radii.
  bool is_clear(const Vec2& from_m, const Vec2& to_m, double radius_m) const;

  /// The distance between the centres of a cell and the nearest blocked cell, in cells, at most 2,047.
  /// Ignores the outside. The error is at most 1/50 cell. Precondition: the cell is in the map.
  double centre_distance_cells(const Cell& cell) const {
    return stored(cell.column, cell.row) / double{kSteps};
  }

 private:
  static constexpr int kSteps = 32;  // distance steps per cell
  /// Bounds the rounding errors of coordinates up to kMaxMapOrigin_m plus the size of a map.
  static constexpr double kRounding_m = 1e-8;

  std::uint16_t stored(int column, int row) const {
    return distances_[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns) +
                      static_cast<std::size_t>(column)];
  }

  MapGrid grid_;
  Vec2 size_m_;
  double cells_per_m_, m_per_step_;
  double margin_m_;                       // half a cell's diagonal, plus quantisation and rounding errors
  std::vector<std::uint16_t> distances_;  // distances in 1 / kSteps cells, rounded to the nearest
};

/// Whether a disc that moves in a straight line touches a blocked cell or the outside. Same result as
/// OccupancyMap::touches(), but most free paths are decided by the map's distance field alone.
inline bool touches(const OccupancyMap& map, const DistanceField& field, const Vec2& from_m, const Vec2& to_m,
                    double radius_m) {
  return !field.is_clear(from_m, to_m, radius_m) && map.touches(from_m, to_m, radius_m);
}

}  // namespace sidestep
