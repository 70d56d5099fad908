// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/field.hpp"
#include "common/protocol/robot_disturbance.hpp"

namespace sidestep {

/// Decodes an untrusted disturbance. Returns nullopt unless its kind is known and the fields that this kind
/// uses are in range. A robot placed at the requested position must be entirely on the field. The result's
/// unused fields may hold any value.
[[nodiscard]] std::optional<RobotDisturbance> decode(const msg::Disturbance& message, const Field& field,
                                                     double robot_radius_m);

/// Encodes a disturbance without its header.
msg::Disturbance encode(const RobotDisturbance& disturbance);

}  // namespace sidestep
