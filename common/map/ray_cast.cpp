// SPDX-License-Identifier: Apache-2.0
#include "common/map/ray_cast.hpp"

#include <stdexcept>

#include "common/collision/time_of_impact.hpp"

namespace sidestep {
namespace {

constexpr double kNoHit = std::numeric_limits<double>::infinity();
/// The free distance at any point of a cell is the distance between centres less at most this: half a
/// diagonal for the point, half a diagonal for the blocked cell, and the error of the stored distance.
constexpr double kCellMargin = 1.4143 + 0.02;
/// Margin that shortens jumps along a ray, so that rounding cannot move its end into a blocked cell.
constexpr double kJumpMargin_m = 1e-8;

/// One axis of a ray on its way through the grid.
struct RayAxis {
  double origin_m, from_m, direction, resolution_m;
  int count;

  /// The distance along the ray at which it leaves a column or row.
  double exit_m(int index) const {
    if (direction == 0) return kNoHit;
    return (origin_m + (index + (direction > 0 ? 1 : 0)) * resolution_m - from_m) / direction;
  }
  int next(int index) const { return direction > 0 ? index + 1 : index - 1; }
  int index_at(double along_m) const {
    const double offset_m = from_m + along_m * direction - origin_m;
    return std::clamp(static_cast<int>(offset_m / resolution_m), 0, count - 1);
  }
  /// The distance along the ray at which it leaves the map.
  double end_m() const { return exit_m(direction > 0 ? count - 1 : 0); }
};

void check_ray(const Vec2& from, const Vec2& direction, double max_m) {
  if (!from.allFinite() || !std::isfinite(max_m))
    throw std::invalid_argument("a ray's start or length is not finite");
  if (!(std::abs(direction.squaredNorm() - 1) < 1e-6))
    throw std::invalid_argument("the direction of a ray is not a unit vector");
}

}  // namespace

double cast_ray(const OccupancyMap& map, const DistanceField& field, const Vec2& from, const Vec2& direction,
                double max_m) {
  check_ray(from, direction, max_m);
  const MapGrid& grid = map.grid();
  Cell cell = map.cell_at(from);
  if (map.is_blocked(cell)) return 0;
  const RayAxis x{grid.origin_m.x(), from.x(), direction.x(), grid.resolution_m, grid.columns};
  const RayAxis y{grid.origin_m.y(), from.y(), direction.y(), grid.resolution_m, grid.rows};
  const double outside_m = std::min(x.end_m(), y.end_m());
  double at_m = 0;
  while (at_m < outside_m && at_m <= max_m) {
    const double free_cells = field.centre_distance_cells(cell) - kCellMargin;
    if (free_cells > 1) {
      at_m += free_cells * grid.resolution_m - kJumpMargin_m;
      cell = {x.index_at(at_m), y.index_at(at_m)};
      continue;
    }
    const double exit_x_m = x.exit_m(cell.column), exit_y_m = y.exit_m(cell.row);
    if (exit_x_m < exit_y_m)
      cell.column = x.next(cell.column);
    else
      cell.row = y.next(cell.row);
    at_m = std::max(at_m, std::min(exit_x_m, exit_y_m));
    if (!grid.has(cell)) break;
    if (map.is_blocked(cell)) return at_m <= max_m ? at_m : kNoHit;
  }
  return outside_m <= max_m ? std::max(0.0, outside_m) : kNoHit;
}

double cast_ray(const RayScene& scene, const Vec2& from, const Vec2& direction, double max_m) {
  check_ray(from, direction, max_m);
  double nearest_m = kNoHit;
  if (scene.map != nullptr) nearest_m = cast_ray(*scene.map, *scene.field, from, direction, max_m);
  const Vec2 end = from + max_m * direction;
  if (scene.shapes != nullptr) {
    if (const std::optional<Contact> contact = scene.shapes->first_contact(from, end, 0))
      nearest_m = std::min(nearest_m, contact->fraction * max_m);
  }
  for (const Circle& disc : scene.discs) {
    if (const std::optional<double> fraction = time_of_impact(Sweep(from, end, 0), disc))
      nearest_m = std::min(nearest_m, *fraction * max_m);
  }
  return nearest_m;
}

}  // namespace sidestep
