// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/protocol/senders.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

inline msg::Disturbance disturbance(RobotId robot, msg::DisturbanceKind kind) {
  msg::Disturbance message;
  message.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
  message.robot(robot);
  message.disturbance_kind(kind);
  return message;
}

}  // namespace sidestep
