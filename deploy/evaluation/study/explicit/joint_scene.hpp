// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "agents/planning/joint/joint_plan.hpp"
#include "common/config/scenario.hpp"

namespace sidestep {

enum class JointScene {
  kSwap,   ///< two groups swap sides among six random circles
  kCircle  ///< robots on a circle, each to the opposite point
};
[[nodiscard]] const char* name_of(JointScene scene);

/// A scene for this number of robots, at least two and even. The same seed gives the same scene. Throws
/// std::invalid_argument for another number.
[[nodiscard]] Scenario joint_scene(JointScene scene, int robots, std::uint64_t seed);

/// The same as a problem for planners; `world` holds the scenario's obstacles.
[[nodiscard]] JointProblem joint_problem(const Scenario& scenario, const ObstacleWorld& world);

/// The time of the longest straight line from a start to a goal, from rest to rest.
[[nodiscard]] double straight_line_s(const JointProblem& problem);

}  // namespace sidestep
