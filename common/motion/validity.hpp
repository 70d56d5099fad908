// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/circle.hpp"
#include "common/geometry/field.hpp"
#include "common/motion/version.hpp"
#include "idl/negotiation.h"

namespace sidestep {

/// What every version has to keep to, whatever the other robots do.
struct FloorRules {
  Field field;
  std::vector<Circle> obstacles;
  MotionLimits limits;
  double radius_m = 0.09;
  double margin_m = 0.01;

  /// The distance that two robots' centres keep.
  double min_separation_m() const { return 2 * radius_m + margin_m; }
};

FloorRules floor_rules(const Scenario& scenario);

/// Whether the trajectory obeys the limits all the way: |v|, A(v) at the start of each phase, D at most
/// within it, at rest at the end. REASON_GRANTED, REASON_BEYOND_LIMITS or REASON_NOT_AT_REST.
msg::Reason check_limits(const Trajectory& trajectory, const MotionLimits& limits);

/// Whether the trajectory stays on the field and clear of the obstacles. REASON_GRANTED, REASON_OUTSIDE_FIELD
/// or REASON_OBSTACLE.
msg::Reason check_place(const Trajectory& trajectory, const FloorRules& rules);

/// Whether a disc that follows the trajectory stays on the field.
bool stays_on(const Field& field, double radius_m, const Trajectory& trajectory);

/// Whether the trajectory starts after the base has, where and as fast as the base is then.
bool continues(const Trajectory& trajectory, const Trajectory& base);

}  // namespace sidestep
