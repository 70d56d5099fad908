// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"

namespace sidestep {

/// A place that a robot must drive to.
struct Goal {
  Vec2 position_m{0, 0};
  std::optional<double> heading_rad{};      ///< nullopt: any heading
  std::optional<double> speed_limit_mps{};  ///< limit on the way there; nullopt: the robot's own limit
  std::optional<double> tolerance_m{};      ///< nullopt: the scenario's tolerance
};

/// The limits of a robot on its way to a goal.
[[nodiscard]] inline MotionLimits limits_to(const Goal& goal, MotionLimits limits) {
  limits.speed_mps = std::min(limits.speed_mps, goal.speed_limit_mps.value_or(limits.speed_mps));
  return limits;
}

}  // namespace sidestep
