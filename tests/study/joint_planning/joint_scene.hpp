// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "agents/planning/joint/joint_plan.hpp"
#include "common/config/scenario.hpp"

namespace sidestep {

enum class JointScene {
  kSwap,   ///< two groups swap sides among six random circles
  kCircle  ///< robots on a circle; each drives to the opposite point
};
[[nodiscard]] const char* name_of(JointScene scene);

/// A scene for this number of robots, which must be even and at least two. The same seed gives the same
/// scene. Throws std::invalid_argument for other numbers.
[[nodiscard]] Scenario joint_scene(JointScene scene, int robots, std::uint64_t seed);

/// The scene as a problem for planners; `world` contains the scenario's obstacles.
[[nodiscard]] JointProblem joint_problem(const Scenario& scenario, const ObstacleWorld& world);

/// The duration of the longest straight motion from a start to its goal, from rest to rest.
[[nodiscard]] double straight_line_s(const JointProblem& problem);

}  // namespace sidestep
