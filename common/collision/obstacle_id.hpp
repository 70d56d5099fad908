// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Identifies an obstacle of a world until it is removed; afterwards the number may be reused.
enum class ObstacleId : std::uint32_t {};

inline constexpr ObstacleId kNoObstacle{0xffffffffu};

}  // namespace sidestep
