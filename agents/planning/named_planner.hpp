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

/// What a planner explored, for pictures.
struct PlanDrawing {
  std::vector<Segment> tree;       ///< or roadmap, or tangents
  std::vector<Segment> goal_tree;  ///< or lines of equal cost
  std::vector<ConvexPolygon> cells;
  std::vector<Vec2> cache;
  std::vector<Circle> band{};  ///< the bubbles along the path, of a local method with a band
};

enum class PlannerKind {
  kForAnyWorld,
  kForOneWorld,  ///< keeps a roadmap or graph of the world, which must not change
  kAnytime,      ///< improves its path until the budget is used up
};

/// The local methods that follow a planner's path; agents/navigation/local_driver.hpp runs them.
struct LocalMethods {
  bool uses_band = false;     ///< the path becomes a bubble band
  bool uses_window = false;   ///< a dynamic window chooses the velocity
  bool uses_field = false;    ///< a potential field chooses it
  bool ignores_path = false;  ///< the window or field heads for the end of the path
};

/// A planner of agents/planning, chosen by name, and the domain settings that belong to it.
struct NamedPlanner {
  std::string name;
  PlannerKind kind = PlannerKind::kForAnyWorld;
  /// The planner that this one is a variant of, or adds one feature to; empty: none.
  std::string baseline;
  /// Valid until the planner's next plan.
  std::function<const Plan<Vec2>&(const DiscDomain&, const Vec2& start, const Budget&, Rng&)> plan;
  std::function<PlanDrawing()> draw;
  std::function<DiscDomainSettings(const Field&, double radius_m)> domain_settings;
  bool is_shortest = false;             ///< its paths cannot be shortened
  bool keeps_clear = false;             ///< its paths keep away from obstacles, which shortcuts would undo
  bool is_random = false;               ///< grows by random samples, and never knows that there is no path
  std::optional<LocalMethods> local{};  ///< none: steering among the other robots follows the path
};

/// The settings that OMPL's RRT and RRTConnect and our planners of the same names share in comparisons.
inline constexpr double kNamesakeGoalBias = 0.05;
/// A fifth of the diagonal of the rectangle of the robot's possible positions: OMPL's default range
/// (ompl::magic::MAX_MOTION_LENGTH_AS_SPACE_EXTENT_FRACTION).
[[nodiscard]] double namesake_range_m(const Field& field, double radius_m);

/// The names that make_planner knows, in the order of the benchmark's table.
const std::vector<std::string>& planner_names();

/// Throws std::invalid_argument for another name.
[[nodiscard]] NamedPlanner make_planner(const std::string& name);

/// One of kDrivingPlanners. Throws std::invalid_argument for another name.
[[nodiscard]] NamedPlanner make_driving_planner(const std::string& name);

}  // namespace sidestep
