// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Where ground truth, or vision where there is none, has shown a robot last.
struct RobotSighting {
  RobotId robot = 0;
  Time at{};  ///< by the clock of the process that saw it
  Vec2 position_m{0, 0};
  double speed_mps = 0;
};

}  // namespace sidestep
