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

/// Converts the protocol's part of a fact. The caller sets the robot's estimate and robot_incarnation.
Feedback from_plain(const robot::Facts& facts, RobotId robot);

inline robot::Vec<double> to_plain(const Vec2& v) { return {v.x(), v.y()}; }

}  // namespace sidestep
