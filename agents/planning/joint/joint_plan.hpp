// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/planning/domain/plan.hpp"
#include "agents/planning/joint/course.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/geometry/field.hpp"
#include "common/motion/limits.hpp"

namespace sidestep {

/// Robots at rest that must all reach their goals. Plans start at Time{}.
struct JointProblem {
  const ObstacleWorld* world = nullptr;  ///< must outlive the planning
  Field field{};
  double radius_m = 0.09;
  double margin_m = 0.014;  ///< distance of robots from each other, obstacles and the field's border
  MotionLimits limits{};
  std::vector<Vec2> starts_m{}, goals_m{};

  std::size_t robots() const { return starts_m.size(); }
  double min_separation_m() const { return 2 * radius_m + margin_m; }
  /// Required distance of a robot's centre from obstacles.
  double distance_from_obstacles_m() const;
};

/// Distance that planners keep in addition to the required distances, to allow for rounding when motions
/// become trajectories.
inline constexpr double kJointTolerance_m = 1e-6;

inline double JointProblem::distance_from_obstacles_m() const {
  return radius_m + margin_m + kJointTolerance_m;
}

/// Throws std::invalid_argument unless there is a world, and a goal for each of at least one robot.
void check(const JointProblem& problem);

/// The motions of all robots. They are clear of each other and of obstacles over all time.
struct JointPlan {
  PlanReason reason = PlanReason::kBudgetSpent;
  std::vector<Course> courses;  ///< one per robot; empty unless the plan succeeds
  std::size_t samples = 0;      ///< number of samples expanded

  bool arrives() const { return reason == PlanReason::kSolved; }
  /// The arrival time of the last robot, in seconds; 0 without courses.
  double makespan_s() const;
};

}  // namespace sidestep
