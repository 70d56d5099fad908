// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/field.hpp"
#include "idl/disturbance.h"

namespace sidestep {

/// Whether a disturbance asks for something that can be: a kind that exists, and within its ranges what the
/// kind uses; a place lies with the robot's whole disc on the field. The rest of the message may be anything.
bool is_sound(const msg::Disturbance& message, const Field& field, double robot_radius_m);

}  // namespace sidestep
