// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Lower bound of the time from the start via all goals: straight lines, rest at each goal, and no other
/// robots. `limits` are those of the robot; the speed limits of its goals apply too.
[[nodiscard]] double straight_line_time_s(const RobotSpec& robot, const MotionLimits& limits);

/// The mean, over the robots that have arrived, of the arrival time over straight_line_time_s(). Robots that
/// need no time, because they have no goal or start at it, do not count. nullopt if no robot counts.
/// `arrivals_s` has the arrival time of each robot, nullopt for those that have not arrived.
[[nodiscard]] std::optional<double> straight_line_time_ratio(
    std::span<const RobotSpec> robots, std::span<const std::optional<double>> arrivals_s,
    const MotionLimits& limits);

}  // namespace sidestep
