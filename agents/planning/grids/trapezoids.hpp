// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/cell_graph.hpp"

namespace sidestep {

struct TrapezoidSettings {
  double corner_rad = 0.2;  ///< by which the polygons that stand for grown obstacles turn at most
};

/// Exact cell decomposition (Latombe 1991, section 5.1): obstacles grown by the robot's radius are polygons
/// whose corners and crossings cut the field into upright strips; in each, the free parts are trapezoids.
/// Exact for those polygons, which are a little larger than what they stand for. Made anew for each query.
class Trapezoids {
 public:
  explicit Trapezoids(const TrapezoidSettings& settings = {}) : settings_(settings) {}

  /// The result is this planner's, until its next plan. Nothing in it is random.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  const CellGraph& cells() const { return graph_; }

 private:
  struct Edge {
    Vec2 left_m, right_m;
    bool is_lower;  // of its polygon
    double y_at(double x) const;
  };
  struct Cell {
    std::uint32_t number;
    double right_low_m, right_high_m;
  };

  void grow_obstacles(const DiscDomain& domain);
  void add_polygon(const std::vector<Vec2>& corners);
  void cut(double half_length_m);
  void fill_strip(double left_m, double right_m, double half_width_m);
  void add_cell(double left_m, double right_m, const Vec2& low_m, const Vec2& high_m);

  TrapezoidSettings settings_;
  std::vector<Edge> edges_;
  std::vector<double> cuts_;
  std::vector<const Edge*> strip_;
  std::vector<Cell> before_, now_;  // cells of the strip on the left, and of this one
  CellGraph graph_;
  CellSearch search_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
