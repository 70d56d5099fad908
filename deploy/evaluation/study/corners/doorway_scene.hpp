// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Sides of the map's cells.
inline constexpr std::array kDoorwayKinds{"2 cm", "5 cm", "10 cm", "20 cm"};

/// One robot with a laser that drives along a corridor, and people who stand in doorways beside it, some
/// hardly wider than they are, and step out when they like. All that matters is random: doorways of 0.3 to
/// 1.2 m, people with a radius of 0.1 to 0.35 m, speeds, the laser. The same seed gives the same scene.
/// `kind`: index of kDoorwayKinds.
[[nodiscard]] Scenario doorway_scene(std::size_t kind, std::uint64_t seed);

}  // namespace sidestep
