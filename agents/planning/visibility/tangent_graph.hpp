// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"
#include "agents/planning/visibility/tangent_arc.hpp"

namespace sidestep {

/// The visibility graph of a disc: all free tangents between arcs, and the parts of the arcs between them,
/// built once for a world. Its paths are shortest paths, except for the standoff and the approximation of
/// arcs by polylines. They are the reference for other planners.
class TangentGraph {
 public:
  TangentGraph(const ObstacleWorld& world, const Field& field, double radius_m);

  /// The result belongs to this planner and is valid until its next plan.
  const Plan<Vec2>& plan(const Vec2& start, const Vec2& goal);

  /// The length of the last plan's path with exact arcs instead of polylines; infinite if there is no path.
  double shortest_m() const { return shortest_m_; }
  /// The free tangents.
  std::vector<Segment> tangents() const;

 private:
  /// The point at which a tangent leaves or reaches a ring, one side of an arc.
  struct Node {
    std::uint32_t ring = 0;  // identifies the arc and side
    Vec2 along;
    double angle_rad = 0;  // angle of the direction; increases along the ring
    std::uint32_t to = 0;  // node at the other end, for a tangent that leaves the ring
    double length_m = 0;   // length of the tangent
    bool leaves = false;
  };
  struct Label {
    double cost_m;
    std::uint32_t parent;
    bool is_done;
  };
  struct Open {
    double estimate_m;
    std::uint32_t node;
  };
  static bool has_higher_estimate(const Open& a, const Open& b) { return a.estimate_m > b.estimate_m; }

  static std::uint32_t ring_of(std::uint32_t arc, Side side) {
    return 2 * arc + (side == Side::kLeft ? 0 : 1);
  }
  static Side side_of(std::uint32_t ring) { return ring % 2 == 0 ? Side::kLeft : Side::kRight; }
  const TangentArc& arc_of(std::uint32_t ring) const { return arcs_[ring / 2]; }
  Vec2 position_of(const Node& node) const;

  bool is_free(const Vec2& from, const Vec2& to) const;
  /// Adds the free tangents between two arcs, of which there are at most four.
  void join(std::uint32_t a, std::uint32_t b);
  void join(std::uint32_t a, Side a_side, std::uint32_t b, Side b_side);
  void add_tangent(std::uint32_t from, std::uint32_t to, const Tangent& tangent);
  void sort_rings();
  void search();
  void relax(std::uint32_t from, std::uint32_t to, double length_m);
  /// Relaxes the next node on the ring, if the arc between the nodes is free.
  void follow_ring(std::uint32_t node);
  void write_plan(std::uint32_t node);

  DiscDomain domain_;
  std::vector<TangentArc> arcs_;  // the start, the goal, then the arcs of the world
  std::vector<Node> nodes_;       // nodes of the world, then nodes of the query
  std::size_t world_nodes_ = 0;
  std::vector<std::vector<std::uint32_t>> rings_;  // indexed by ring, sorted by angle_rad
  std::vector<std::uint32_t> index_in_ring_;       // indexed by node
  std::vector<Label> labels_;
  std::vector<Open> queue_;
  std::vector<Vec2> vertices_;
  std::vector<std::uint32_t> path_;
  double shortest_m_ = 0;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
