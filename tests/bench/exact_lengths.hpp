// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/cost_grid.hpp"

namespace sidestep {

/// Lengths of a point's shortest paths to a goal among blocked square cells, for grids in which no free
/// straight line is longer than kReach cells. Shortest paths turn only at corners of single blocked cells, so
/// this is Dijkstra's algorithm over such corners that see each other. Visibility is found by casting shadows
/// in integer arithmetic. Paths touch corners, but do not squeeze between two cells at a corner.
class ExactLengths {
 public:
  static constexpr int kReach = 80;

  ExactLengths(const CostGrid& grid, const Vec2& goal_m);

  /// The length of the shortest path from a position to the goal, in cells; infinite if there is no path.
  double length(const Vec2& from_m) const;

 private:
  struct Direction {
    std::int64_t x, y;
  };
  /// The directions from `low` to `high`, with the corners that bound them.
  struct Cone {
    Direction low, high;
  };

  bool is_blocked(std::int64_t column, std::int64_t row) const;
  bool is_turn(std::int64_t x, std::int64_t y) const;
  std::size_t corner(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>(y * (columns_ + 1) + x);
  }
  void relax(std::int64_t x, std::int64_t y, double length);
  void search();
  void look_along(std::int64_t x, std::int64_t y, int step_x, int step_y, double length);
  void look_into(std::int64_t x, std::int64_t y, int side_x, int side_y, double length);

  const CostGrid& grid_;
  Vec2 goal_m_;
  std::int64_t columns_, rows_;
  std::vector<double> lengths_;  // indexed by corner
  struct Open {
    double length;
    std::size_t corner;
    bool operator<(const Open& other) const { return length > other.length; }
  };
  std::vector<Open> queue_;
  std::vector<Cone> cones_, next_;
};

}  // namespace sidestep
