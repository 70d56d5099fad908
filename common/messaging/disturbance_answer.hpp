// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/motion/version.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// The result in an answer of the simulator to this disturbance; nullopt if the answer is malformed or
/// belongs to another disturbance.
[[nodiscard]] std::optional<msg::DisturbanceResult> result_in(const msg::DisturbanceAnswer& answer,
                                                              const msg::Disturbance& disturbance);

/// Why the simulator has refused a disturbance of this robot, for example "robot 5 is on the floor".
/// Precondition: the result is a valid enumerator other than FAULT_APPLIED.
std::string refusal_text(RobotId robot, msg::DisturbanceResult result);

}  // namespace sidestep
