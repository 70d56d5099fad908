// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/fault_command.hpp"

#include <CLI/CLI.hpp>

#include "deploy/fault/link_command.hpp"
#include "deploy/fault/network_command.hpp"
#include "deploy/fault/robot_command.hpp"

namespace sidestep {

void add_fault_command(CLI::App& root, std::function<int()>& action) {
  CLI::App* fault = root.add_subcommand("fault", "Disturbs a run that goes on: its network, its robots");
  fault->require_subcommand(1);
  add_network_command(*fault, action);
  add_robot_commands(*fault, action);
  add_link_commands(*fault, action);
}

}  // namespace sidestep
