// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A place that a robot must drive to.
struct Goal {
  Vec2 position_m{0, 0};
  std::optional<double> heading_rad{};      ///< nullopt: any heading
  std::optional<double> speed_limit_mps{};  ///< limit on the way there; nullopt: the robot's own limit
  std::optional<double> tolerance_m{};      ///< nullopt: the scenario's tolerance
};

}  // namespace sidestep
