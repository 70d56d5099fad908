// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Names of the kinds of scenes: the cell sizes of their maps.
inline constexpr std::array kDoorwayKinds{"2 cm", "5 cm", "10 cm", "20 cm"};

/// A scene with one robot that drives along a corridor and has a laser, and people who stand in doorways
/// beside it and step out at any time. Some doorways are hardly wider than the person. Doorways (0.3 to 1.2
/// m), people (radius 0.1 to 0.35 m), speeds and the laser are random. The same seed gives the same scene.
/// `kind` is an index of kDoorwayKinds.
[[nodiscard]] Scenario doorway_scene(std::size_t kind, std::uint64_t seed);

}  // namespace sidestep
