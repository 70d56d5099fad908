// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/protocol/robot_messages.hpp"
#include "idl/robot.hpp"

namespace sidestep {

/// Decodes an untrusted command. Returns nullopt unless it is for `robot`, its sender is an agent of `robot`,
/// and every field is finite and plausible at `now` (by the local clock). Only the capture time of the pose
/// fix may be arbitrary.
[[nodiscard]] std::optional<Command> decode(const msg::Command& message, RobotId robot, Time now);
/// Decodes an untrusted robot report. Returns nullopt unless `robot` sent it about itself, all numbers are
/// finite, and version, incarnations, epoch and times are valid and plausible at `now` (by the local clock).
[[nodiscard]] std::optional<RobotReport> decode(const msg::Feedback& message, RobotId robot, Time now);

/// Encodes a command without the header's message_number and stamp_ns, which Writer::publish() sets.
msg::Command encode(const Command& command);
/// Encodes a robot report without the header's message_number and stamp_ns.
msg::Feedback encode(const RobotReport& robot_report);

}  // namespace sidestep
