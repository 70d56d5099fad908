// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/study/potential/field_drive.hpp"

namespace sidestep {

/// A method that decides where the robot drives.
struct FieldMethod {
  enum class Kind { kPotential, kNf1, kEStar };
  Kind kind = Kind::kPotential;
  double rotation = 0;  ///< for a potential field, see PotentialFieldSettings
};
[[nodiscard]] std::string name_of(const FieldMethod& method);

/// Creates a method's direction function for a world. The world and its obstacles must outlive it. Computes
/// navigation functions for a slightly larger disc. In cells that are blocked for that disc, the direction
/// leads away from the nearest obstacle.
[[nodiscard]] DriveDirection direction_of(const FieldMethod& method, const PlanWorld& world,
                                          const ObstacleWorld& obstacles);

}  // namespace sidestep
