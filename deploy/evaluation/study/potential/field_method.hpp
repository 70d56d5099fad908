// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/evaluation/study/potential/field_drive.hpp"

namespace sidestep {

/// What tells the robot where to drive.
struct FieldMethod {
  enum class Kind { kPotential, kNf1, kEStar };
  Kind kind = Kind::kPotential;
  double rotation = 0;  ///< of a potential field: see PotentialFieldSettings
};
[[nodiscard]] std::string name_of(const FieldMethod& method);

/// A method's direction anywhere in a world, which has to outlive it, as do its obstacles. Navigation
/// functions are computed here, for a disc that is a little larger, and lead out of cells that they block
/// away from the nearest obstacle.
[[nodiscard]] DriveDirection direction_of(const FieldMethod& method, const PlanWorld& world,
                                          const ObstacleWorld& obstacles);

}  // namespace sidestep
