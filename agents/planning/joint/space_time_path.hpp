// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/planning/joint/space_time_domain.hpp"

namespace sidestep {

/// Leaves out states and shortens waits of a free path, as long as it stays free. Never arrives later.
void shorten(const SpaceTimeDomain& domain, std::vector<SpaceTimeState>& path);

/// The course of a robot along a path from its start on, without the waits.
[[nodiscard]] Course course_along(const std::vector<SpaceTimeState>& path, const MotionLimits& limits);

}  // namespace sidestep
