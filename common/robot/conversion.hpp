// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/version.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/robot/robot_side.hpp"

namespace sidestep {

/// Convert between the robot side's plain types and the types of the rest of the system. A version converted
/// to the plain type and back is bit-identical.
robot::Version to_plain(const Version& version);
Version from_plain(const robot::Version& version, RobotId robot);

/// Converts the protocol's part of a robot's report. The caller sets the robot's estimate and
/// robot_incarnation.
RobotReport from_plain(const robot::RobotReport& plain, RobotId robot);

/// Passes the protocol's part of a command to the robot side. Returns whether its sender is an agent that the
/// robot obeys.
template <typename Real>
[[nodiscard]] bool pass_command(const Command& command, Time now, robot::RobotSide<Real>& side,
                                robot::StableMemory& memory) {
  const robot::Version version = command.version ? to_plain(*command.version) : robot::Version{};
  const robot::Command plain{command.incarnation, command.epoch, to_ns(command.sent_at),
                             command.version ? &version : nullptr};
  return side.on_command(plain, to_ns(now), memory);
}

inline robot::Vec<double> to_plain(const Vec2& v) { return {v.x(), v.y()}; }

}  // namespace sidestep
