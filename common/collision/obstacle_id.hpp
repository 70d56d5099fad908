// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Names an obstacle of one world from when it is added until it is removed; then the number may be given
/// again.
enum class ObstacleId : std::uint32_t {};

inline constexpr ObstacleId kNoObstacle{0xffffffffu};

}  // namespace sidestep
