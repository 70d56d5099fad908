// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"
#include "agents/planning/grids/navigation/world_field.hpp"

namespace sidestep {

struct NavigationSettings {
  WorldFieldSettings field = {};
};

/// Plans paths that descend a navigation function. Keeps the functions for the last two radii or floors: a
/// replan to the same goal computes only the values that a new start or changed obstacles require. The path
/// is the same as the path of a newly created planner. Cells are blocked conservatively, so a passage must be
/// up to three cells wider than the disc; PlanReason::kUnreachable applies to these cells only. The number of
/// cells limits the effort. Only the budget's time limit applies: once it has passed, the planner tries no
/// further ways to join the goal to the grid. Does not allocate once warm.
class NavigationPlanner {
 public:
  explicit NavigationPlanner(const NavigationSettings& settings = {}) : settings_(settings) {}

  /// The result belongs to this planner and is valid until its next plan. Deterministic.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  /// Short lines along the directions in which the last function descends.
  std::vector<Segment> directions() const;
  /// Lines of equal cost of the last function, as far as it was computed, spaced by 0.25 m of free floor.
  std::vector<Segment> iso_lines() const;

 private:
  /// A position on the grid that a start or goal is joined to.
  struct Join {
    Vec2 at_m{0, 0};
    GridCell cell = 0;
    double distance_m = 0;
  };

  WorldField* field_of(const DiscDomain& domain);
  std::optional<GridCell> free_cell_at(const Vec2& position) const;
  void find_joins(const DiscDomain& domain, const Vec2& position, std::vector<Join>& joins) const;
  void search(const DiscDomain& domain, const Vec2& start, const Budget& budget);
  bool descend(const DiscDomain& domain, const Vec2& start, const Join& from, const Vec2& goal);
  void forget_reached(std::vector<Join>& joins) const;

  NavigationSettings settings_;
  std::vector<std::unique_ptr<WorldField>> fields_;  // most recently used first
  std::vector<Join> start_joins_, goal_joins_;
  std::vector<Vec2> descent_m_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
