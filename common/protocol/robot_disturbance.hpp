// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// External disturbance of one robot; see Disturbance in idl/disturbance.idl. Each kind uses some of the
/// fields.
struct RobotDisturbance {
  RobotId robot = 0;
  msg::DisturbanceKind kind = msg::DisturbanceKind::DISTURBANCE_PUSH;
  Vec2 push_mps{0, 0};       ///< change of velocity
  double grip = 1;           ///< while slipping
  Vec2 place_m{0, 0};        ///< where it is put down, or carried to; or how far beside its place it is seen
  double heading_rad = 0;    ///< of the blocked wheel (body frame), or with which it is put down
  Duration clock_offset{0};  ///< of the robot's clock, ahead of the host's
  Duration duration{0};      ///< of slipping, blocking, carrying or being seen wrongly
  RobotId other_robot = 0;   ///< with which cameras confuse it
};

}  // namespace sidestep
