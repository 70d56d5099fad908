// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// An error in how cameras see a robot.
struct VisionFault {
  struct Pose {
    Vec2 position_m{0, 0};
    double heading_rad = 0;
  };
  Vec2 offset_m{0, 0};                  ///< offset from its true place to where they show it
  std::optional<std::size_t> shown_as;  ///< index of the robot as which they report it
  std::optional<Pose> frozen;           ///< they show it at this pose, wherever it is
};

}  // namespace sidestep
