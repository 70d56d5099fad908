// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/protocol/robot_observation.hpp"
#include "idl/negotiation.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// Decodes an untrusted observation of a robot. Returns nullopt if its robot, position, velocity or
/// variance is out of range, or its time is implausible at `now`, by the local clock.
[[nodiscard]] std::optional<RobotObservation> decode(const msg::TrackedRobot& message, Time now);
/// Decodes the place of a displaced or silent robot from an untrusted message, with the same checks.
/// Precondition: is_uncontrolled(message).
[[nodiscard]] std::optional<RobotObservation> decode(const msg::RobotNotice& message, Time now);
/// Writes the place of a displaced or silent robot. Limits the speed to what receivers accept: a position
/// that jumps between two observations looks like any speed.
void encode(const RobotObservation& observation, msg::RobotNotice& message);

}  // namespace sidestep
