// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// An observation of a robot by vision.
struct RobotObservation {
  RobotId robot = 0;
  Time observed_at{};
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
  double position_variance_m2 = 0;  ///< variance on each axis
};

}  // namespace sidestep
