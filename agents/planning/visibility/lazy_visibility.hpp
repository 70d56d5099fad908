// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"
#include "agents/planning/visibility/known_obstacles.hpp"
#include "agents/planning/visibility/tangent_arc.hpp"

namespace sidestep {

/// Finds the shortest path of a disc among obstacles: A* over the tangents between arcs. A tangent is checked
/// only when it is the most promising tangent, and an obstacle is considered only once it blocks a checked
/// tangent. A query therefore considers few obstacles, even in a world with many.
class LazyVisibility {
 public:
  /// The result belongs to this planner and is valid until its next plan. Deterministic. kUnreachable means
  /// that no path keeps the standoff.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  /// The tangents along which the last search reached arcs.
  std::vector<Segment> explored_tangents() const;

 private:
  /// A path that arrives at an arc in direction `along`.
  struct Arrival {
    std::uint32_t arc = 0;
    Side side = Side::kLeft;
    Vec2 along{0, 0};
    double cost_m = 0;           // length up to the tangent point
    double turn_rad = 0;         // turn along the parent's arc
    double vertex_turn_rad = 0;  // maximum turn at a vertex of this arc; 0: turn_rad is still a lower bound
    std::uint32_t parent;        // arrival at the previous arc of the path
    std::uint32_t previous;      // previously found arrival at this arc and side
  };
  /// A candidate that has not been checked yet, with a lower bound of the length of a path through it to the
  /// goal.
  struct OpenEntry {
    double cost_m;
    std::uint32_t candidate;
  };
  struct CostsMore {
    bool operator()(const OpenEntry& a, const OpenEntry& b) const { return a.cost_m > b.cost_m; }
  };

  void plan_from(const DiscDomain& domain, const Vec2& start, const Budget& budget);
  void plan_from_blocked(const DiscDomain& domain, const Vec2& start, const Budget& budget);
  void begin_search(const DiscDomain& domain, const Vec2& start);
  bool search(const DiscDomain& domain, const Budget& budget);
  void expand(const DiscDomain& domain, std::uint32_t arrival, std::uint32_t first_arc);
  void add_candidates(const DiscDomain& domain, std::uint32_t arrival, const TangentArc& from,
                      std::uint32_t arc);
  void push(const OpenEntry& entry);
  OpenEntry pop();
  /// Replaces the lower bound of the turn by the turn itself; returns the increase of the cost.
  double refine_cost(Arrival& next) const;
  /// Whether an earlier arrival can follow the arc to the tangent point of `next` at no more cost.
  bool is_dominated(const DiscDomain& domain, const Arrival& next);
  /// Whether the parent's arc is free up to the tangent; sets next.vertex_turn_rad.
  bool is_arc_free(const DiscDomain& domain, Arrival& next);
  bool is_tangent_free(const DiscDomain& domain, const Arrival& next);
  bool is_arc_free(const DiscDomain& domain, const Arrival& at, double turn_rad, const Vec2& along,
                   double vertex_turn_rad);
  bool is_free(const DiscDomain& domain, const Vec2& from, const Vec2& to);
  /// Adds the first obstacle that blocks a motion to the known obstacles, unless it is known already.
  void discover(const DiscDomain& domain, const Vec2& from, const Vec2& to);
  /// Hides corners that lie in another obstacle or outside the field, since no shortest path turns at them.
  /// These are corners of the newest obstacle, whose arcs start at `first_arc`, and older corners that it
  /// covers.
  void hide_covered_corners(const Field& field, std::size_t first_arc);
  void write_plan(std::uint32_t arrival);

  std::vector<TangentArc> arcs_;  // the start, the goal, then the arcs of the known obstacles
  KnownObstacles known_;
  std::vector<std::uint8_t> is_hidden_;  // indexed by arc: not needed by any shortest path
  std::vector<Arrival> arrivals_;        // expanded so far
  std::vector<std::uint32_t> last_;      // indexed by arc and side: last arrival
  std::vector<Arrival> candidates_;
  std::vector<OpenEntry> queue_;          // a heap
  std::vector<std::uint32_t> promising_;  // arcs that may have a tangent from the expanded arc
  std::vector<Vec2> vertices_;
  std::vector<std::uint32_t> path_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
