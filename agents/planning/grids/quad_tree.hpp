// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/cell_graph.hpp"

namespace sidestep {

struct QuadTreeSettings {
  int depth = 8;  ///< of the tree: the smallest cell is the field's length / 2^depth wide
};

/// Approximate cell decomposition: squares that are neither free nor blocked are quartered, down to a
/// smallest one, which is left out. Made anew for each query.
class QuadTree {
 public:
  explicit QuadTree(const QuadTreeSettings& settings = {}) : settings_(settings) {}

  /// The result is this planner's, until its next plan. Nothing in it is random.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  const CellGraph& cells() const { return graph_; }

 private:
  void divide(const DiscDomain& domain, int x, int y, int size);
  void add_cell(int x, int y, int size);
  void join_neighbours();
  void join(int x, int y, int size, bool upwards);

  struct Square {
    int x, y, size;
  };
  QuadTreeSettings settings_;
  double unit_m_ = 0;
  Vec2 corner_m_{0, 0};
  int side_ = 0;                        // in units
  std::vector<std::uint32_t> cell_at_;  // by unit
  std::vector<Square> squares_;         // by cell
  CellGraph graph_;
  CellSearch search_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
