// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/cell_graph.hpp"

namespace sidestep {

struct TrapezoidalDecompositionSettings {
  double vertex_turn_rad = 0.2;  ///< maximum turn at a vertex of the polygons that approximate arcs
};

/// Exact cell decomposition (Latombe 1991, section 5.1). Obstacles inflated by the robot's radius are
/// approximated by polygons; vertical lines through their vertices and intersections cut the field into
/// slabs, in which the free parts are trapezoids. Exact for these polygons, which are slightly larger than
/// the inflated obstacles. Rebuilt for each query.
class TrapezoidalDecomposition {
 public:
  explicit TrapezoidalDecomposition(const TrapezoidalDecompositionSettings& settings = {})
      : settings_(settings) {}

  /// The result belongs to this planner and is valid until its next plan. Deterministic.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  const CellGraph& cells() const { return graph_; }

 private:
  struct Edge {
    Vec2 left_m, right_m;
    bool is_lower;  // part of the lower boundary of its polygon
    double y_at(double x) const;
  };
  struct Cell {
    std::uint32_t index;
    double right_low_m, right_high_m;
  };

  void inflate_obstacles(const DiscDomain& domain);
  void add_polygon(const std::vector<Vec2>& vertices);
  void find_cuts(double half_length_m);
  void fill_slab(double left_m, double right_m, double half_width_m);
  void add_cell(double left_m, double right_m, const Vec2& low_m, const Vec2& high_m);

  TrapezoidalDecompositionSettings settings_;
  std::vector<Edge> edges_;
  std::vector<double> cuts_;
  std::vector<const Edge*> slab_edges_;
  std::vector<Cell> left_cells_, current_cells_;  // of the slab to the left, and of the current slab
  CellGraph graph_;
  CellSearch search_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
