// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A fault in how cameras see a robot.
struct VisionFault {
  struct Pose {
    Vec2 position_m{0, 0};
    double heading_rad = 0;
  };
  Vec2 offset_m{0, 0};                  ///< from the true position to where cameras show the robot
  std::optional<std::size_t> shown_as;  ///< index of another robot as which cameras report it
  std::optional<Pose> frozen;           ///< cameras show the robot at this pose, wherever it is
};

}  // namespace sidestep
