// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

inline msg::Disturbance disturbance(RobotId robot, msg::DisturbanceKind kind) {
  msg::Disturbance message;
  message.robot(robot);
  message.disturbance_kind(kind);
  return message;
}

}  // namespace sidestep
