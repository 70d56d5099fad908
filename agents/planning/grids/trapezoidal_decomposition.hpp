// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/cell_graph.hpp"
#include "agents/planning/grids/funnel.hpp"
#include "agents/planning/grids/trapezoidal_map.hpp"
#include "agents/planning/grids/winding_segments.hpp"

namespace sidestep {

/// Exact cell decomposition (Latombe 1991, section 5.1) by the trapezoidal map of the obstacles' boundaries
/// (de Berg et al. 2008, section 13.2). Obstacles inflated by the robot's radius are approximated by
/// polygons, whose corners are rounded to an integer grid; the trapezoids that no polygon covers are the
/// cells. It is exact for these polygons, which are slightly larger than the inflated obstacles. Rebuilt for
/// each query, in expected time O((n + k) log n) after k crossings have been found.
class TrapezoidalDecomposition {
 public:
  /// The result belongs to this planner and is valid until its next plan. Deterministic.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  const CellGraph& cells() const { return graph_; }
  /// The cell at a position, in the last query that had no straight path; nullopt if an obstacle covers it.
  /// Takes logarithmic time.
  std::optional<std::uint32_t> cell_at(const Vec2& position_m) const;

 private:
  /// Chooses the unit of the grid. Returns false if the robot does not fit into the field.
  bool choose_grid(const DiscDomain& domain);
  void add_boundaries(const DiscDomain& domain);
  void add_polygon(const std::vector<Vec2>& vertices_m);
  /// Computes the number of polygons that cover each trapezoid.
  void count_covers();
  void cover(TrapezoidalMap::Index trapezoid, std::int32_t count);
  void add_cells();
  void add_cell(TrapezoidalMap::Index trapezoid);
  void add_portals(TrapezoidalMap::Index trapezoid);
  /// Replaces the path over the midpoints of portals with the shortest path through the same portals.
  void shorten(const DiscDomain& domain, const Vec2& start);
  Vec2 in_metres(double x, double y) const { return {unit_m_ * x, unit_m_ * y}; }
  GridPoint rounded(const Vec2& position_m) const;

  double unit_m_ = 1;     // unit of the grid
  GridPoint half_field_;  // half the size of the area in which the robot's centre may lie
  CrossingDivider divider_;
  std::vector<WindingSegment> boundaries_;
  std::vector<GridSegment> segments_;
  TrapezoidalMap map_;
  std::vector<std::int32_t> covers_;          // indexed by trapezoid
  std::vector<TrapezoidalMap::Index> above_;  // indexed by segment: a trapezoid above it
  std::vector<TrapezoidalMap::Index> below_;
  std::vector<TrapezoidalMap::Index> open_;
  std::vector<std::uint32_t> cell_of_;  // indexed by trapezoid
  CellGraph graph_;
  std::vector<PortalEdge> walls_;         // indexed by portal, as seen from left to right
  std::vector<PortalEdge> path_portals_;  // portals of the path
  std::vector<Vec2> shortened_;
  CellSearch search_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
