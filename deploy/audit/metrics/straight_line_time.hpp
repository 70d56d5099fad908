// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"

namespace sidestep {

/// Lower bound of the time from the start via all goals: straight lines, rest at each goal, and no other
/// robots. `limits` are those of the robot; the speed limits of its goals apply too.
[[nodiscard]] double straight_line_time_s(const RobotSpec& robot, const MotionLimits& limits);

}  // namespace sidestep
