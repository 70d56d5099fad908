// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/field.hpp"
#include "common/motion/floor_rules.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// The result of checking a trajectory against the floor rules: valid, or the first rule that it violates.
enum class Validity {
  kValid,
  kBeyondLimits,  ///< speed or acceleration exceeds its limit
  kNotAtRest,     ///< the trajectory does not end at rest
  kOutsideField,
  kObstacle
};

/// Checks the motion limits over the whole trajectory: the speed, A(v) throughout each phase, and rest at the
/// end. Returns kValid, kBeyondLimits or kNotAtRest.
[[nodiscard]] Validity check_limits(const Trajectory& trajectory, const MotionLimits& limits);

/// Checks that a robot on this trajectory stays on the field and clear of the static obstacles. Returns
/// kValid, kOutsideField or kObstacle.
[[nodiscard]] Validity check_workspace(const Trajectory& trajectory, const FloorRules& rules);

/// Whether a disc that follows the trajectory stays on the field.
[[nodiscard]] bool stays_on(const Field& field, double radius_m, const Trajectory& trajectory);

/// Whether the trajectory starts later than its base, at the position and velocity that the base has at that
/// time.
[[nodiscard]] bool continues(const Trajectory& trajectory, const Trajectory& base);

}  // namespace sidestep
