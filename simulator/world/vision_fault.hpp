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
  Vec2 offset_m{0, 0};  ///< offset from the robot's true position to the position that cameras show
  std::optional<std::size_t> shown_as;  ///< index of another robot as which cameras report it
  std::optional<Pose> frozen;           ///< pose at which cameras show the robot, regardless of its true pose
};

}  // namespace sidestep
