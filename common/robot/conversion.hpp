// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/version.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/robot/robot_side.hpp"

namespace sidestep {

/// Between the robot side's plain types and those of the rest. A version that comes back from the robot side
/// equals the one that went in, bit for bit.
robot::Version to_plain(const Version& version);
Version from_plain(const robot::Version& version, RobotId robot);

/// The protocol's part of a fact; the caller sets the robot's estimate and robot_incarnation.
Feedback from_plain(const robot::Facts& facts, RobotId robot);

inline robot::Vec<double> to_plain(const Vec2& v) { return {v.x(), v.y()}; }

}  // namespace sidestep
