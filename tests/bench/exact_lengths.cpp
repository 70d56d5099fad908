// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/exact_lengths.hpp"

#include <algorithm>

#include "agents/planning/grids/navigation/line_of_sight.hpp"

namespace sidestep {
namespace {

/// Positive if b lies to the left of a.
template <typename Direction>
std::int64_t turn(const Direction& a, const Direction& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

ExactLengths::ExactLengths(const CostGrid& grid, const Vec2& goal_m)
    : grid_(grid), goal_m_(goal_m), columns_(grid.layout().columns), rows_(grid.layout().rows) {
  lengths_.assign(static_cast<std::size_t>((columns_ + 1) * (rows_ + 1)),
                  std::numeric_limits<double>::infinity());
  const Vec2 goal = grid.layout().in_cells(goal_m);
  const auto is_free = [&](GridCell cell) { return !grid_.is_blocked(cell); };
  for (std::int64_t y = 0; y <= rows_; ++y) {
    for (std::int64_t x = 0; x <= columns_; ++x) {
      const Vec2 at(static_cast<double>(x), static_cast<double>(y));
      if ((at - goal).cwiseAbs().maxCoeff() > kReach || !is_turn(x, y)) continue;
      // Looks from a point slightly beside the corner, towards the goal.
      if (sees(grid.layout(), goal, at + 1e-7 * (goal - at), is_free)) relax(x, y, (at - goal).norm());
    }
  }
  search();
}

double ExactLengths::length(const Vec2& from_m) const {
  const Vec2 from = grid_.layout().in_cells(from_m), goal = grid_.layout().in_cells(goal_m_);
  const auto is_free = [&](GridCell cell) { return !grid_.is_blocked(cell); };
  double shortest = std::numeric_limits<double>::infinity();
  if (sees(grid_.layout(), from, goal, is_free)) shortest = (from - goal).norm();
  const auto first_x = std::max<std::int64_t>(static_cast<std::int64_t>(from.x()) - kReach, 0);
  const auto first_y = std::max<std::int64_t>(static_cast<std::int64_t>(from.y()) - kReach, 0);
  for (std::int64_t y = first_y; y <= std::min(first_y + 2 * kReach, rows_); ++y) {
    for (std::int64_t x = first_x; x <= std::min(first_x + 2 * kReach, columns_); ++x) {
      const Vec2 at(static_cast<double>(x), static_cast<double>(y));
      const double length = lengths_[corner(x, y)] + (at - from).norm();
      if (length < shortest && sees(grid_.layout(), from, at + 1e-7 * (from - at), is_free))
        shortest = length;
    }
  }
  return shortest;
}

bool ExactLengths::is_blocked(std::int64_t column, std::int64_t row) const {
  return column < 0 || row < 0 || column >= columns_ || row >= rows_ ||
         grid_.is_blocked(static_cast<GridCell>(row * columns_ + column));
}

bool ExactLengths::is_turn(std::int64_t x, std::int64_t y) const {
  return is_blocked(x, y) + is_blocked(x - 1, y) + is_blocked(x, y - 1) + is_blocked(x - 1, y - 1) == 1;
}

void ExactLengths::relax(std::int64_t x, std::int64_t y, double length) {
  if (length >= lengths_[corner(x, y)]) return;
  lengths_[corner(x, y)] = length;
  queue_.push_back({length, corner(x, y)});
  std::push_heap(queue_.begin(), queue_.end());
}

void ExactLengths::search() {
  while (!queue_.empty()) {
    const Open open = queue_.front();
    std::pop_heap(queue_.begin(), queue_.end());
    queue_.pop_back();
    if (open.length > lengths_[open.corner]) continue;
    const auto at = static_cast<std::int64_t>(open.corner);
    const std::int64_t x = at % (columns_ + 1), y = at / (columns_ + 1);
    // A path that turns at this corner passes through the two quadrants next to the blocked cell's quadrant,
    // in either direction.
    const bool is_rising = is_blocked(x, y) || is_blocked(x - 1, y - 1);
    look_into(x, y, 1, is_rising ? -1 : 1, open.length);
    look_into(x, y, -1, is_rising ? 1 : -1, open.length);
    look_along(x, y, 1, 0, open.length);
    look_along(x, y, -1, 0, open.length);
    look_along(x, y, 0, 1, open.length);
    look_along(x, y, 0, -1, open.length);
  }
}

/// Relaxes the corners on a grid line up to where both cells beside the line are blocked.
void ExactLengths::look_along(std::int64_t x, std::int64_t y, int step_x, int step_y, double length) {
  const double start = length;
  for (int steps = 1;; ++steps) {
    // The cells on both sides of the edge that ends in the next corner.
    const std::int64_t left_x = x + std::min(step_x, 0) - (step_x == 0),
                       left_y = y + std::min(step_y, 0) - (step_y == 0);
    const std::int64_t right_x = x + std::min(step_x, 0), right_y = y + std::min(step_y, 0);
    const bool left = is_blocked(left_x, left_y), right = is_blocked(right_x, right_y);
    if (left && right) return;
    x += step_x, y += step_y;
    if (is_turn(x, y)) relax(x, y, start + steps);
    const bool a = is_blocked(x, y) && is_blocked(x - 1, y - 1),
               b = is_blocked(x - 1, y) && is_blocked(x, y - 1);
    if (a || b) return;
  }
}

/// Relaxes the corners in a quadrant that are visible from a corner, row by row.
void ExactLengths::look_into(std::int64_t x, std::int64_t y, int side_x, int side_y, double length) {
  const auto blocked = [&](std::int64_t i, std::int64_t j) {
    return is_blocked(side_x > 0 ? x + i : x - 1 - i, side_y > 0 ? y + j : y - 1 - j);
  };
  cones_.assign(1, {{1, 0}, {0, 1}});
  for (std::int64_t j = 0; !cones_.empty(); ++j) {
    next_.clear();
    for (Cone cone : cones_) {
      // Keeps the part of a cone above the direction `low`, unless that part squeezes between two cells.
      const auto keep = [&](const Direction& low) {
        const Cone part{turn(cone.low, low) >= 0 ? low : cone.low, cone.high};
        const bool is_squeezed = part.low.x == part.high.x && part.low.y == part.high.y;
        const bool is_border = part.low.x == 0;  // look_along() follows the quadrant's borders
        if (turn(part.low, part.high) >= 0 && !is_squeezed && !is_border) next_.push_back(part);
      };
      bool is_left = true;
      // Cells that touch the cone only with a corner may make it squeeze between two cells.
      const std::int64_t first = (cone.high.x * j + cone.high.y - 1) / cone.high.y - 1;
      for (std::int64_t i = std::max<std::int64_t>(first, 0); is_left; ++i) {
        if (cone.low.y > 0 && i * cone.low.y > cone.low.x * (j + 1)) break;  // beyond the cone
        if (!blocked(i, j)) continue;
        keep({i, j + 1});
        const Direction below{i + 1, j};
        if (turn(below, cone.high) >= 0) cone.high = below;
        is_left = cone.high.y > 0 && turn(cone.low, cone.high) >= 0 &&
                  !(cone.low.x == cone.high.x && cone.low.y == cone.high.y);
      }
      if (is_left) keep(cone.low);
    }
    std::swap(cones_, next_);
    for (const Cone& cone : cones_) {
      const std::int64_t last = cone.low.x * (j + 1) / cone.low.y;
      for (std::int64_t i = (cone.high.x * (j + 1) + cone.high.y - 1) / cone.high.y; i <= last; ++i) {
        if (i == 0) continue;  // on the quadrant's border
        const std::int64_t to_x = x + side_x * i, to_y = y + side_y * (j + 1);
        if (!is_turn(to_x, to_y)) continue;
        const auto off_x = static_cast<double>(i), off_y = static_cast<double>(j + 1);
        relax(to_x, to_y, length + std::sqrt(off_x * off_x + off_y * off_y));
      }
    }
  }
}

}  // namespace sidestep
