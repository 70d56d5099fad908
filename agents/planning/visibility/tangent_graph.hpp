// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"
#include "agents/planning/visibility/bend.hpp"

namespace sidestep {

struct TangentGraphSettings {
  double stand_off_m = 1e-7;  ///< by which ways keep off obstacles more than they have to
  double corner_rad = 0.02;   ///< by which the way turns at most, at one of its corners
};

/// The visibility graph of a disc: all free tangents between all bends, and the arcs between them, built once
/// for a world. Its ways are the shortest there are, up to the stand-off and what corners add to arcs: what
/// others are measured by.
class TangentGraph {
 public:
  TangentGraph(const ObstacleWorld& world, const Field& field, double radius_m,
               const TangentGraphSettings& settings = {});

  /// The result is this planner's, until its next plan.
  const Plan<Vec2>& plan(const Vec2& start, const Vec2& goal);

  /// The length of the last plan's way with true arcs; infinite when there is none.
  double shortest_m() const { return shortest_m_; }
  /// The free tangents.
  std::vector<Segment> tangents() const;

 private:
  /// Where ways touch a bend on one side and go straight on, or come from.
  struct Node {
    std::uint32_t ring;  // bend and side
    Vec2 along;
    double angle_rad;      // of the direction, rising as the way goes on
    std::uint32_t to = 0;  // at the other end, for a way that leaves
    double length_m = 0;   // of the tangent
    bool leaves = false;
  };
  struct Label {
    double cost_m;
    std::uint32_t before;
    bool is_done;
  };
  struct Open {
    double promise_m;
    std::uint32_t node;
  };
  static bool promises_less(const Open& a, const Open& b) { return a.promise_m > b.promise_m; }

  static std::uint32_t ring_of(std::uint32_t bend, Side side) {
    return 2 * bend + (side == Side::kLeft ? 0 : 1);
  }
  static Side side_of(std::uint32_t ring) { return ring % 2 == 0 ? Side::kLeft : Side::kRight; }
  const Bend& bend_of(std::uint32_t ring) const { return bends_[ring / 2]; }
  Vec2 place_of(const Node& node) const;

  bool is_free(const Vec2& from, const Vec2& to) const;
  /// Joins two bends with the four ways between them.
  void join(std::uint32_t a, std::uint32_t b);
  void join(std::uint32_t a, Side a_side, std::uint32_t b, Side b_side);
  void add_tangent(std::uint32_t from, std::uint32_t to, const Tangent& tangent);
  void sort_rings();
  void search();
  void relax(std::uint32_t from, std::uint32_t to, double length_m);
  /// From a node to the next on its ring, if the way round the bend is free.
  void follow_ring(std::uint32_t node);
  void write_plan(std::uint32_t node);

  TangentGraphSettings settings_;
  DiscDomain domain_;
  std::vector<Bend> bends_;  // the start and the goal first
  std::vector<Node> nodes_;  // those of the world first, then those of a query
  std::size_t world_nodes_ = 0;
  std::vector<std::vector<std::uint32_t>> rings_;  // nodes in order
  std::vector<std::uint32_t> place_in_ring_;       // by node
  std::vector<Label> labels_;
  std::vector<Open> queue_;
  std::vector<Vec2> corners_;
  std::vector<std::uint32_t> way_;
  double shortest_m_ = 0;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
