// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/descent.hpp"

#include <array>

#include "agents/planning/grids/navigation/line_of_sight.hpp"

namespace sidestep {
namespace {

constexpr double kStep = 0.5;             // step of a traced path, in cells
constexpr double kDescent = 0.1 * kStep;  // minimum decrease of the value in each step

/// The cells between whose centres a position lies, except those not reachable from it, and their weights.
struct Corners {
  std::array<GridCell, 4> cells{};
  std::array<double, 4> weights{};
  std::size_t count = 0;
};

bool is_reached(const EStar& field, std::int64_t column, std::int64_t row) {
  const GridLayout& layout = field.layout();
  if (column < 0 || row < 0 || column >= layout.columns || row >= layout.rows) return false;
  const GridCell cell = layout.cell(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
  return !field.is_blocked(cell) && field.value(cell) < kBlocked;
}

/// The corners for a position in cells. Empty if the position's own cell is not reached.
Corners corners_at(const EStar& field, const Vec2& at) {
  Corners corners;
  if (!(at.array().abs() < 1e9).all()) return corners;
  const auto column = static_cast<std::int64_t>(std::floor(at.x()));
  const auto row = static_cast<std::int64_t>(std::floor(at.y()));
  if (!is_reached(field, column, row)) return corners;
  const double x = at.x() - static_cast<double>(column) - 0.5, y = at.y() - static_cast<double>(row) - 0.5;
  const int side_x = x < 0 ? -1 : 1, side_y = y < 0 ? -1 : 1;
  const bool beside = is_reached(field, column + side_x, row),
             above = is_reached(field, column, row + side_y);
  const auto add = [&](std::int64_t to_x, std::int64_t to_y, double weight) {
    corners.cells[corners.count] =
        field.layout().cell(static_cast<std::uint32_t>(to_x), static_cast<std::uint32_t>(to_y));
    corners.weights[corners.count++] = weight;
  };
  const double far_x = std::abs(x), far_y = std::abs(y);
  add(column, row, (1 - far_x) * (1 - far_y));
  if (beside) add(column + side_x, row, far_x * (1 - far_y));
  if (above) add(column, row + side_y, (1 - far_x) * far_y);
  if (beside && above && is_reached(field, column + side_x, row + side_y))
    add(column + side_x, row + side_y, far_x * far_y);
  return corners;
}

/// The decrease towards the lower of two neighbours on an axis, with the sign of its direction.
double decrease(float value, float before, float after) {
  const float lowest = std::min(before, after);
  if (!(lowest < value)) return 0;
  return before <= after ? -(value - lowest) : value - lowest;
}

/// The direction of descent at the centre of a reached cell: a unit vector, or 0 without lower neighbours.
Vec2 direction_of(const EStar& field, GridCell cell) {
  const GridLayout& layout = field.layout();
  const float value = field.value(cell);
  Vec2 along(0, 0);
  if (value == field.exact_value(cell)) {
    along = field.exact_target_m(cell) - layout.centre_of(cell);
  } else {
    const std::uint32_t column = cell % layout.columns, row = cell / layout.columns;
    const auto neighbour = [&](bool exists, GridCell other) {
      return exists && !field.is_blocked(other) ? field.value(other) : kBlocked;
    };
    along.x() =
        decrease(value, neighbour(column > 0, cell - 1), neighbour(column + 1 < layout.columns, cell + 1));
    along.y() = decrease(value, neighbour(row > 0, cell - layout.columns),
                         neighbour(row + 1 < layout.rows, cell + layout.columns));
  }
  const double length = along.norm();
  return length > 0 ? Vec2(along / length) : Vec2(0, 0);
}

/// The interpolated value at a position in cells; infinite where the field is not reached.
double value_at(const EStar& field, const Vec2& at) {
  const Corners corners = corners_at(field, at);
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < corners.count; ++i) {
    sum += corners.weights[i] * field.value(corners.cells[i]);
    weights += corners.weights[i];
  }
  return weights > 0 ? sum / weights : std::numeric_limits<double>::infinity();
}

bool is_free(const EStar& field, const Vec2& from, const Vec2& to) {
  return sees(field.layout(), from, to, [&](GridCell cell) { return !field.is_blocked(cell); });
}

/// The lowest of the four neighbours, or the cell itself if none is lower.
GridCell lowest_neighbour(const EStar& field, GridCell cell) {
  const GridLayout& layout = field.layout();
  GridCell lowest = cell;
  const auto consider = [&](bool exists, GridCell other) {
    if (exists && !field.is_blocked(other) && field.value(other) < field.value(lowest)) lowest = other;
  };
  consider(cell % layout.columns > 0, cell - 1);
  consider((cell + 1) % layout.columns > 0, cell + 1);
  consider(cell >= layout.columns, cell - layout.columns);
  consider(cell + layout.columns < layout.size(), cell + layout.columns);
  return lowest;
}

/// Builds a path; positions are in cells.
class Tracer {
 public:
  Tracer(const EStar& field, std::vector<Vec2>& path_m)
      : field_(field), layout_(field.layout()), goal_(layout_.in_cells(field.goal_m())), path_m_(path_m) {}

  bool trace(const Vec2& from) {
    at_ = from;
    while (!arrive()) {
      if (descend()) continue;
      if (!descend_by_cells()) return false;
      if (has_arrived_) return true;
    }
    return true;
  }

 private:
  void add(const Vec2& to) {
    path_m_.push_back(layout_.origin_m + layout_.resolution_m * to);
    at_ = to;
  }

  GridCell cell() const {
    return layout_.cell(static_cast<std::uint32_t>(at_.x()), static_cast<std::uint32_t>(at_.y()));
  }

  /// Ends the path if the rest of it is known exactly and is almost straight up to its first turn.
  bool arrive() {
    const GridCell from = cell();
    if (field_.value(from) != field_.exact_value(from)) return false;
    const float cost = field_.cost(from);
    const Vec2 target = layout_.in_cells(field_.exact_target_m(from));
    // The direction from a point slightly beside a corner towards this position.
    const Vec2 end = target == goal_ ? target : Vec2(target + 1e-7 * (at_ - target));
    if (!sees(layout_, at_, end, [&](GridCell other) { return field_.cost(other) == cost; })) return false;
    field_.append_exact_path(from, path_m_);
    return true;
  }

  /// Makes one step along the gradient, or along an axis if an obstacle is in the way.
  bool descend() {
    const Vec2 step = kStep * direction_at(field_, layout_.origin_m + layout_.resolution_m * at_);
    const double value = value_at(field_, at_);
    for (const Vec2& by : {step, Vec2(step.x(), 0), Vec2(0, step.y())}) {
      const Vec2 to = at_ + by;
      if (!(value_at(field_, to) <= value - kDescent) || !is_free(field_, at_, to)) continue;
      add(to);
      return true;
    }
    return false;
  }

  /// Moves from centre to centre until the value is lower; false if there is no lower cell, which means that
  /// the values are not final.
  bool descend_by_cells() {
    const double value = value_at(field_, at_);
    GridCell at = cell();
    do {
      if (field_.value(at) == field_.exact_value(at)) {
        add(layout_.in_cells(layout_.centre_of(at)));
        field_.append_exact_path(at, path_m_);
        return has_arrived_ = true;
      }
      const GridCell next = lowest_neighbour(field_, at);
      if (next == at) return false;
      at = next;
      add(layout_.in_cells(layout_.centre_of(at)));
    } while (field_.value(at) > value - kDescent);
    return true;
  }

  const EStar& field_;
  const GridLayout& layout_;
  Vec2 goal_, at_{0, 0};
  std::vector<Vec2>& path_m_;
  bool has_arrived_ = false;
};

}  // namespace

Vec2 direction_at(const EStar& field, const Vec2& position_m) {
  const Vec2 at = field.layout().in_cells(position_m);
  const Corners corners = corners_at(field, at);
  if (corners.count == 0) return {0, 0};
  const Vec2 to_goal = field.goal_m() - position_m;
  const bool is_at_goal = field.layout().cell_at(field.goal_m()) == corners.cells[0];
  Vec2 sum(0, 0);
  for (std::size_t i = 0; i < corners.count && !is_at_goal; ++i)
    sum += corners.weights[i] * direction_of(field, corners.cells[i]);
  // The directions cancel out between two equally good ways around an obstacle, so one way is chosen.
  if (!is_at_goal && sum.norm() < 1e-9) sum = direction_of(field, corners.cells[0]);
  if (is_at_goal) sum = to_goal;
  const double length = sum.norm();
  return length > 0 ? Vec2(sum / length) : Vec2(0, 0);
}

bool trace(const EStar& field, const Vec2& from_m, std::vector<Vec2>& path_m) {
  path_m.clear();
  const auto cell = field.layout().cell_at(from_m);
  if (!cell || field.is_blocked(*cell) || !(field.value(*cell) < kBlocked)) return false;
  path_m.push_back(from_m);
  if (Tracer(field, path_m).trace(field.layout().in_cells(from_m))) return true;
  path_m.clear();
  return false;
}

}  // namespace sidestep
