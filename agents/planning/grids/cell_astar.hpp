// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/map/bit_grid.hpp"
#include "common/map/map_grid.hpp"

namespace sidestep {

/// Heuristics: lower bounds of the remaining path, except kManhattan, which overestimates if there are
/// diagonal steps.
enum class CellHeuristic {
  kNone,       ///< no heuristic: Dijkstra's algorithm
  kStraight,   ///< the Euclidean distance
  kOctile,     ///< the exact length on a grid without obstacles
  kManhattan,  ///< not admissible with diagonal steps: paths may be longer than necessary
};

/// A path from cell to cell.
struct CellRoute {
  std::vector<Cell> cells;  ///< from start to goal; empty: there is no path
  double length_cells = 0;
  std::size_t expanded = 0;  ///< number of cells whose neighbours were examined
};

/// A* on the free cells of a grid with eight neighbours. A diagonal step requires both cells beside it to be
/// free. With an admissible heuristic the path is a shortest path. Reuses its memory between searches.
class CellAstar {
 public:
  explicit CellAstar(CellHeuristic heuristic = CellHeuristic::kOctile) : heuristic_(heuristic) {}

  /// Cells whose bit is 1 are blocked; start and goal count as free. Precondition: both are in the grid. The
  /// result is valid until the next search.
  const CellRoute& search(const BitGrid& blocked, const Cell& start, const Cell& goal);

  /// The heuristic's value for a displacement in cells.
  static double estimate(CellHeuristic heuristic, int columns, int rows);

 private:
  struct Open {
    double estimate, cost;
    std::uint32_t cell;
  };

  void push(const BitGrid& blocked, const Cell& to, double cost, std::uint32_t from);
  void expand(const BitGrid& blocked, std::uint32_t cell);
  void write_route(std::uint32_t start, std::uint32_t goal);
  bool is_free(const BitGrid& blocked, const Cell& cell) const;
  std::uint32_t number_of(const Cell& cell) const {
    return static_cast<std::uint32_t>(cell.row * columns_ + cell.column);
  }
  Cell cell_of(std::uint32_t number) const {
    return {static_cast<int>(number) % columns_, static_cast<int>(number) / columns_};
  }

  CellHeuristic heuristic_;
  int columns_ = 0;
  Cell start_, goal_;
  std::vector<double> cost_;         // indexed by cell
  std::vector<std::uint32_t> from_;  // indexed by cell
  std::vector<Open> open_;           // a heap
  CellRoute route_;
};

}  // namespace sidestep
