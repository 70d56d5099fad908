// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/fault_command.hpp"

#include "common/process/command_line.hpp"
#include "deploy/trial/fault/link_command.hpp"
#include "deploy/trial/fault/network_command.hpp"
#include "deploy/trial/fault/robot_command.hpp"

namespace sidestep {

void add_fault_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand fault = root.add_subcommand("fault", "Disturbs a running system: its network, its robots");
  fault.require_subcommand();
  add_network_command(fault, action);
  add_robot_commands(fault, action);
  add_link_commands(fault, action);
}

}  // namespace sidestep
