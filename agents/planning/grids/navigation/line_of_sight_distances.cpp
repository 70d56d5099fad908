// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/line_of_sight_distances.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTouch = 1e-9;  // positions this close to the edge of a cone count as on it

std::int64_t floor_of(double x) { return static_cast<std::int64_t>(std::floor(x)); }
std::int64_t ceil_of(double x) { return static_cast<std::int64_t>(std::ceil(x)); }

}  // namespace

LineOfSightDistances::LineOfSightDistances(const GridLayout& layout)
    : columns_(layout.columns),
      rows_(layout.rows),
      open_((std::size_t{layout.columns} + 2) * (layout.rows + 2)),
      cell_lengths_(layout.size()),
      sources_(layout.size()),
      lengths_((std::size_t{layout.columns} + 1) * (layout.rows + 1)),
      parents_(lengths_.size()) {}

void LineOfSightDistances::set_open(GridCell cell, bool is_open) {
  const auto column = cell % columns_, row = cell / columns_;
  open_[static_cast<std::size_t>((row + 1) * (columns_ + 2) + column + 1)] = is_open;
}

Vec2 LineOfSightDistances::position(Corner corner) const {
  if (corner == kGoal) return goal_;
  return {static_cast<double>(corner % (columns_ + 1)), static_cast<double>(corner / (columns_ + 1))};
}

bool LineOfSightDistances::is_turn(std::int64_t x, std::int64_t y) const {
  return is_closed(x, y) + is_closed(x - 1, y) + is_closed(x, y - 1) + is_closed(x - 1, y - 1) == 1;
}

void LineOfSightDistances::compute(const Vec2& goal) {
  goal_ = goal;
  std::fill(cell_lengths_.begin(), cell_lengths_.end(), std::numeric_limits<float>::infinity());
  std::fill(lengths_.begin(), lengths_.end(), kInfinite);
  queue_.clear();
  look_from_goal();
  while (queue_.advance([this](Corner corner) { return static_cast<float>(lengths_[corner]); })) {
    const auto& bucket = queue_.first_lane();
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const Corner corner = bucket[i];
      if (queue_.is_in_current(static_cast<float>(lengths_[corner]))) look_from(corner);
    }
    queue_.first_lane().clear();
  }
}

void LineOfSightDistances::reach_cell(std::int64_t column, std::int64_t row, const Frame& frame) {
  if (is_closed(column, row)) return;
  const double x = static_cast<double>(column) + 0.5 - frame.position.x(),
               y = static_cast<double>(row) + 0.5 - frame.position.y();
  const double before = frame.from == kGoal ? 0 : lengths_[frame.from];
  const auto length = static_cast<float>(before + std::sqrt(x * x + y * y));
  const auto cell = static_cast<std::size_t>(row * columns_ + column);
  if (!(length < cell_lengths_[cell])) return;
  cell_lengths_[cell] = length;
  sources_[cell] = frame.from;
}

void LineOfSightDistances::reach_corner(std::int64_t x, std::int64_t y, Corner from, const Vec2& position) {
  if (x < 0 || y < 0 || x > columns_ || y > rows_ || !is_turn(x, y)) return;
  const auto corner = static_cast<Corner>(y * (columns_ + 1) + x);
  const double dx = static_cast<double>(x) - position.x(), dy = static_cast<double>(y) - position.y();
  const double length = (from == kGoal ? 0 : lengths_[from]) + std::sqrt(dx * dx + dy * dy);
  if (!(length < lengths_[corner])) return;
  lengths_[corner] = length;
  parents_[corner] = from;
  queue_.push(static_cast<float>(length), corner);
}

/// Reaches the free cells in the goal's row, and everything seen through their lower and upper borders.
void LineOfSightDistances::look_from_goal() {
  const std::int64_t column = floor_of(goal_.x()), row = floor_of(goal_.y());
  if (is_closed(column, row)) return;
  std::int64_t first = column, end = column + 1;
  while (!is_closed(first - 1, row)) --first;
  while (!is_closed(end, row)) ++end;
  for (const int step : {-1, 1}) {
    const double height = std::max(
        kTouch, step > 0 ? static_cast<double>(row + 1) - goal_.y() : goal_.y() - static_cast<double>(row));
    const Frame frame{kGoal, goal_, column, row + step, 1, step, goal_.x() - static_cast<double>(column),
                      height};
    for (std::int64_t x = first; x <= end; ++x) {
      reach_corner(x, step > 0 ? row + 1 : row, kGoal, goal_);
      if (x < end) reach_cell(x, row, frame);
    }
    cast(frame, {(static_cast<double>(first) - goal_.x()) / height,
                 (static_cast<double>(end) - goal_.x()) / height});
  }
}

/// Reaches everything seen from a corner where a path turns. The path bends around the corner's closed cell,
/// into directions between its straight continuation and the cell's edge.
void LineOfSightDistances::look_from(Corner corner) {
  const std::int64_t x = corner % (columns_ + 1), y = corner / (columns_ + 1);
  const int closed_x = is_closed(x, y) || is_closed(x, y - 1) ? 1 : -1;
  const int closed_y = is_closed(x, y) || is_closed(x - 1, y) ? 1 : -1;
  const Vec2 at = position(corner), back = position(parents_[corner]) - at;
  // Transformed as if the closed cell were at the upper right.
  const double u = back.x() * closed_x, v = back.y() * closed_y;
  const auto look_into = [&](int step_x, int step_y, const Cone& cone) {
    cast({corner, at, step_x > 0 ? x : x - 1, step_y > 0 ? y : y - 1, step_x, step_y, 0, 0}, cone);
  };
  if (u <= 0 && v > 0) {  // the path comes from the upper left
    look_along(x, y, closed_x, 0, corner);
    look_into(closed_x, -closed_y, {-u / v, kInfinite});
  } else if (u > 0 && v <= 0) {  // the path comes from the lower right
    look_along(x, y, 0, closed_y, corner);
    look_into(-closed_x, closed_y, {0, v < 0 ? -u / v : kInfinite});
  }
}

/// Reaches the corners on a grid line, as far as a cell on either side of the line is open.
void LineOfSightDistances::look_along(std::int64_t x, std::int64_t y, std::int64_t step_x,
                                      std::int64_t step_y, Corner from) {
  const Vec2 position = this->position(from);
  while (true) {
    // The cells on both sides of the edge that ends in the next corner.
    const std::int64_t edge_x = x + std::min<std::int64_t>(step_x, 0),
                       edge_y = y + std::min<std::int64_t>(step_y, 0);
    if (is_closed(edge_x - (step_x == 0), edge_y - (step_y == 0)) && is_closed(edge_x, edge_y)) return;
    x += step_x, y += step_y;
    reach_corner(x, y, from, position);
    if (is_closed(x, y) && is_closed(x - 1, y - 1)) return;
    if (is_closed(x - 1, y) && is_closed(x, y - 1)) return;
  }
}

/// Reaches all centres and corners within a cone, half a row at a time.
void LineOfSightDistances::cast(const Frame& frame, const Cone& cone) {
  cones_.assign(1, cone);
  for (std::int64_t j = 0;; ++j) {
    const double near = frame.first_row + static_cast<double>(j);
    const std::int64_t row = frame.row + frame.step_y * j;
    split(frame, row, near, near + 0.5);
    for (const Cone& seen : cones_) {
      const double shift = frame.offset - 0.5;
      const std::int64_t last = floor_of(seen.high * (near + 0.5) + shift + kTouch);
      for (std::int64_t i = ceil_of(seen.low * (near + 0.5) + shift - kTouch); i <= last; ++i)
        reach_cell(frame.column + frame.step_x * i, row, frame);
    }
    split(frame, row, near + 0.5, near + 1);
    if (cones_.empty()) return;
    for (const Cone& seen : cones_) {
      const std::int64_t last = floor_of(seen.high * (near + 1) + frame.offset + kTouch);
      for (std::int64_t i = ceil_of(seen.low * (near + 1) + frame.offset - kTouch); i <= last; ++i)
        reach_corner(frame.column + frame.step_x * i + (frame.step_x < 0), row + (frame.step_y > 0),
                     frame.from, frame.position);
    }
  }
}

/// Removes from the cones the directions that the closed cells of a row hide between two heights.
void LineOfSightDistances::split(const Frame& frame, std::int64_t row, double near, double far) {
  next_cones_.clear();
  const std::int64_t limit = frame.step_x > 0 ? columns_ - frame.column : frame.column + 1;
  for (const Cone& cone : cones_) {
    double low = cone.low;
    std::int64_t i = floor_of((low < 0 ? low * far : low * near) + frame.offset);
    const double right = (cone.high > 0 ? cone.high * far : cone.high * near) + frame.offset;
    const std::int64_t last = right < static_cast<double>(limit) ? floor_of(right) : limit;
    const auto closed = [&](std::int64_t k) { return is_closed(frame.column + frame.step_x * k, row); };
    while (low < cone.high) {
      while (i <= last && !closed(i)) ++i;
      if (i > last) break;
      const double begin = static_cast<double>(i) - frame.offset;
      while (i <= last && closed(i)) ++i;
      const double end = static_cast<double>(i) - frame.offset;
      const double hidden_from = begin < 0 ? begin / near : begin / far;
      const double hidden_to = end > 0 ? end / near : end / far;
      if (hidden_from > low) next_cones_.push_back({low, std::min(hidden_from, cone.high)});
      low = std::max(low, hidden_to);
    }
    if (low < cone.high) next_cones_.push_back({low, cone.high});
  }
  std::swap(cones_, next_cones_);
}

}  // namespace sidestep
