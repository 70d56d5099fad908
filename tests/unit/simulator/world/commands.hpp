// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/codec.hpp"
#include "idl/robot.h"

namespace sidestep::test {

/// A command without a version.
inline msg::Command bare_command(RobotId robot, Incarnation incarnation) {
  msg::Command command;
  command.robot(robot);
  command.header().sender(robot);
  command.header().incarnation(incarnation);
  return command;
}

inline msg::Command command_with(const Version& version) {
  msg::Command command = bare_command(version.robot, version.incarnation);
  command.has_version(true);
  command.version(encode(version));
  return command;
}

}  // namespace sidestep::test
