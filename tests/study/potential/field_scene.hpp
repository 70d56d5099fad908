// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "deploy/trial/planning/worlds.hpp"

namespace sidestep {

enum class FieldScene {
  kU,         ///< a U that is open towards the start
  kWall,      ///< a wall across the straight line
  kCorridor,  ///< a long corridor, slightly wider than the robot
  kGap,       ///< a gap between two discs that are close together
  kDiscs      ///< twelve random discs
};
inline constexpr std::array kFieldScenes{FieldScene::kU, FieldScene::kWall, FieldScene::kCorridor,
                                         FieldScene::kGap, FieldScene::kDiscs};
[[nodiscard]] const char* name_of(FieldScene scene);

/// Range of the widths, beyond the robot's width, of corridors and gaps in random scenes.
inline constexpr double kMinSpare_m = 0.2, kMaxSpare_m = 0.5;

/// A world with one query that is solvable with some clearance. The same seed gives the same scene.
[[nodiscard]] PlanWorld field_scene(FieldScene scene, std::uint64_t seed);

/// A corridor that is wider than the robot by this much.
[[nodiscard]] PlanWorld corridor_scene(double spare_m, std::uint64_t seed);

}  // namespace sidestep
