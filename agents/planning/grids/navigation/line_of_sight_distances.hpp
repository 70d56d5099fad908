// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "agents/planning/grids/navigation/bucket_queue.hpp"
#include "agents/planning/grids/navigation/grid_layout.hpp"

namespace sidestep {

/// Exact lengths of a point robot's shortest paths from the centres of open cells to a goal. Shortest paths
/// turn only at corners that have exactly one closed cell (taut paths, as in Anya: Harabor et al. 2016), so
/// Dijkstra's algorithm searches these corners. From each corner, lines of sight are cast only into the space
/// behind the corner. Paths may touch closed cells, but not squeeze between two closed cells that meet at a
/// corner. Does not allocate once warm.
class LineOfSightDistances {
 public:
  /// A corner of cells, or kGoal.
  using Corner = std::uint32_t;
  static constexpr Corner kGoal = 0x7fffffff;

  explicit LineOfSightDistances(const GridLayout& layout);

  /// Opens or closes a cell. Initially all cells are closed.
  void set_open(GridCell cell, bool is_open);
  /// Recomputes all lengths. The goal is in cells from the origin. Precondition: it lies in the grid.
  void compute(const Vec2& goal);

  /// The length in cells; infinite if there is no path.
  float length(GridCell cell) const { return cell_lengths_[cell]; }
  /// The first corner on the path from a cell with a finite length.
  Corner source(GridCell cell) const { return sources_[cell]; }
  /// The next corner on the path from `corner`. Precondition: `corner` is not the goal.
  Corner next(Corner corner) const { return parents_[corner]; }
  /// The corner's position in cells from the origin.
  Vec2 position(Corner corner) const;

 private:
  /// Two slopes, horizontal over vertical, between which everything is seen.
  struct Cone {
    double low, high;
  };
  /// The rows seen from a position. In this frame, cell (i, j) spans i - offset to i + 1 - offset
  /// horizontally, and first_row + j to first_row + j + 1 vertically, relative to the position.
  struct Frame {
    Corner from;
    Vec2 position;
    std::int64_t column, row;  // cell (0, 0) of the frame
    int step_x, step_y;
    double offset, first_row;
  };

  bool is_closed(std::int64_t column, std::int64_t row) const {
    return open_[static_cast<std::size_t>((row + 1) * (columns_ + 2) + column + 1)] == 0;
  }
  bool is_turn(std::int64_t x, std::int64_t y) const;
  void reach_cell(std::int64_t column, std::int64_t row, const Frame& frame);
  void reach_corner(std::int64_t x, std::int64_t y, Corner from, const Vec2& position);
  void look_from_goal();
  void look_from(Corner corner);
  void look_along(std::int64_t x, std::int64_t y, std::int64_t step_x, std::int64_t step_y, Corner from);
  void cast(const Frame& frame, const Cone& cone);
  void split(const Frame& frame, std::int64_t row, double near, double far);

  std::int64_t columns_, rows_;
  std::vector<std::uint8_t> open_;  // with a border of one closed cell on each side
  std::vector<float> cell_lengths_;
  std::vector<Corner> sources_;
  std::vector<double> lengths_;  // indexed by corner
  std::vector<Corner> parents_;
  Vec2 goal_{0, 0};
  BucketQueue queue_;
  std::vector<Cone> cones_, next_cones_;
};

}  // namespace sidestep
