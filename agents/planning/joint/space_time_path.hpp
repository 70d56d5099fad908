// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/planning/joint/space_time_domain.hpp"

namespace sidestep {

/// Removes states and shortens waits while the path stays free. Never delays the path's arrival.
void shorten(const SpaceTimeDomain& domain, std::vector<SpaceTimeState>& path);

/// The course of a robot that follows a path from its start on. Waits are not legs: the robot rests between
/// legs.
[[nodiscard]] Course course_along(const std::vector<SpaceTimeState>& path, const MotionLimits& limits);

}  // namespace sidestep
