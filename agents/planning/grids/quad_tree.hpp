// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/cell_graph.hpp"

namespace sidestep {

/// Approximate cell decomposition: squares that are neither completely free nor completely blocked are
/// divided into four, down to a minimum size; squares that are then still undecided are dropped. Rebuilt for
/// each query.
class QuadTree {
 public:
  /// The result belongs to this planner and is valid until its next plan. Deterministic.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  const CellGraph& cells() const { return graph_; }

 private:
  void subdivide(const DiscDomain& domain, int x, int y, int size);
  void add_cell(int x, int y, int size);
  void join_neighbours();
  void join(int x, int y, int size, bool upwards);
  /// Index of a unit square in cell_at_.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x);
  }

  struct Square {
    int x, y, size;
  };
  double unit_m_ = 0;
  Vec2 origin_m_{0, 0};
  int side_ = 0;                        // side of the root square, in units of the smallest square
  std::vector<std::uint32_t> cell_at_;  // indexed by unit square
  std::vector<Square> squares_;         // indexed by cell
  CellGraph graph_;
  CellSearch search_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
