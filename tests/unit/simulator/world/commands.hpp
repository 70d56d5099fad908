// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/robot_messages.hpp"

namespace sidestep::test {

/// A command without a version.
inline Command bare_command(RobotId robot, Incarnation incarnation) {
  Command command;
  command.robot = robot;
  command.incarnation = incarnation;
  return command;
}

inline Command command_with(const Version& version) {
  Command command = bare_command(version.robot, version.incarnation);
  command.version = version;
  return command;
}

}  // namespace sidestep::test
