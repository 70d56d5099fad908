// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// Largest change of velocity by a push, in each direction.
inline constexpr double kMaxPush_mps = 10;

/// External disturbance of one robot; see Disturbance in idl/disturbance.idl. Each kind uses only some of the
/// fields.
struct RobotDisturbance {
  RobotId robot = 0;
  msg::DisturbanceKind kind = msg::DisturbanceKind::DISTURBANCE_PUSH;
  Vec2 push_mps{0, 0};       ///< change of velocity
  double grip = 1;           ///< grip while slipping
  Vec2 place_m{0, 0};        ///< destination of placing or carrying, or offset at which cameras see the robot
  double heading_rad = 0;    ///< direction of the blocked wheel (body frame), or heading when put down
  Duration clock_offset{0};  ///< offset of the robot's clock from the host's; positive: ahead
  Duration duration{0};      ///< duration for which the robot slips, is blocked, carried or seen wrongly
  RobotId other_robot = 0;   ///< robot that cameras confuse with this robot
};

}  // namespace sidestep
