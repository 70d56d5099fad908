// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"
#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The parts of the world that a planner explored, for pictures.
struct PlanDrawing {
  std::vector<Segment> tree;       ///< a search tree, a roadmap, or tangents
  std::vector<Segment> goal_tree;  ///< a tree from the goal, or lines of equal cost
  std::vector<ConvexPolygon> cells;
  std::vector<Vec2> cache;
  std::vector<Circle> band{};  ///< the bubbles along the path, for a local method with a band
};

enum class PlannerKind {
  kForAnyWorld,
  kForOneWorld,  ///< keeps a roadmap or graph of the world, which must not change
  kAnytime,      ///< improves its path until the budget is used up
};

/// The local methods that follow a planner's path. agents/navigation/local_driver.hpp runs them.
struct LocalMethods {
  bool uses_band = false;     ///< the path becomes a bubble band
  bool uses_window = false;   ///< a dynamic window chooses the velocity
  bool uses_field = false;    ///< a potential field chooses the velocity
  bool ignores_path = false;  ///< the window or field heads for the end of the path
};

/// A planner of agents/planning, selected by name, with its domain settings.
struct NamedPlanner {
  std::string name;
  PlannerKind kind = PlannerKind::kForAnyWorld;
  /// Name of the planner that this planner modifies or extends; empty: none.
  std::string baseline;
  /// Valid until the planner's next plan.
  std::function<const Plan<Vec2>&(const DiscDomain&, const Vec2& start, const Budget&, Rng&)> plan;
  std::function<PlanDrawing()> draw;
  std::function<DiscDomainSettings(const Field&, double radius_m)> domain_settings;
  bool is_shortest = false;             ///< its paths cannot be shortened
  bool keeps_clear = false;             ///< its paths keep away from obstacles, which shortcuts would undo
  bool is_random = false;               ///< grows by random samples, and cannot detect that there is no path
  std::optional<LocalMethods> local{};  ///< nullopt: steering among the other robots follows the path
};

/// Goal bias that OMPL's RRT and our planner of the same name share in comparisons.
inline constexpr double kOmplGoalBias = 0.05;
/// Step length that OMPL's planners and our planners of the same names share in comparisons: a fifth of the
/// diagonal of the rectangle of the robot's possible positions, OMPL's default range
/// (ompl::magic::MAX_MOTION_LENGTH_AS_SPACE_EXTENT_FRACTION).
[[nodiscard]] double ompl_range_m(const Field& field, double radius_m);

/// The names that make_planner() accepts, in the order of the benchmark's table.
const std::vector<std::string>& planner_names();

/// Throws std::invalid_argument for unknown names.
[[nodiscard]] NamedPlanner make_planner(const std::string& name);

/// `name` must be one of kDrivingPlanners. Throws std::invalid_argument for other names.
[[nodiscard]] NamedPlanner make_driving_planner(const std::string& name);

}  // namespace sidestep
