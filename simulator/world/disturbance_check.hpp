// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/field.hpp"
#include "idl/disturbance.h"

namespace sidestep {

/// Whether a disturbance is of a known kind and the fields that this kind uses are in range. A place must
/// have the robot's whole disc on the field. Unused fields may hold any value.
[[nodiscard]] bool is_valid(const msg::Disturbance& message, const Field& field, double robot_radius_m);

}  // namespace sidestep
