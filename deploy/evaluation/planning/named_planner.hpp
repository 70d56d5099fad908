// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// What a planner looked at, to be drawn.
struct PlanDrawing {
  std::vector<Segment> tree;    ///< or roadmap, or tangents
  std::vector<Segment> others;  ///< the tree from the goal
  std::vector<ConvexPolygon> cells;
  std::vector<Vec2> cache;
};

enum class PlannerKind {
  kForAnyWorld,
  kForOneWorld,  ///< keeps what it knows of a world, which must not change
  kAnytime,      ///< uses up its budget
};

/// A planner that was chosen by its name, with its defaults.
struct NamedPlanner {
  std::string name;
  PlannerKind kind = PlannerKind::kForAnyWorld;
  /// The result is the planner's, until its next plan.
  std::function<const Plan<Vec2>&(const DiscDomain&, const Vec2& start, const Budget&, Rng&)> plan;
  std::function<PlanDrawing()> draw;
};

/// The names that make_planner knows, in the order of the benchmark's table.
const std::vector<std::string>& planner_names();

/// Throws std::invalid_argument for another name.
NamedPlanner make_planner(const std::string& name);

}  // namespace sidestep
