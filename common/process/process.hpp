// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/command_line.hpp"
#include "common/process/exit_code.hpp"

namespace sidestep {

/// The parts of a program that differ from the others; run_process() provides the rest.
struct Program {
  std::string name;         ///< e.g. sidestep-agent
  std::string description;  ///< one sentence for --help
  /// Adds the program's own options to --scenario, --domain and --interface. May be empty.
  std::function<void(const CliCommand&)> add_options;
  /// The name of the DDS participant and of the process in its log, e.g. agent-3; called after the options
  /// are parsed. Empty: `name`.
  std::function<std::string()> participant;
  /// The process id (common/messaging/senders.hpp); called after the options are parsed.
  std::function<std::uint32_t()> process;
  /// Creates the nodes on the bus; run_process() keeps the result until the bus has stopped. May throw;
  /// std::invalid_argument for an option that does not fit the scenario.
  std::function<std::shared_ptr<void>(DdsBus&, const Scenario&)> start;
};

/// The main function of a process on DDS: parses the options, loads the scenario, starts the program and runs
/// until SIGINT or SIGTERM. Returns the exit code. The log of the process is on stderr, in the name of the
/// participant.
int run_process(int argc, char** argv, const Program& program);

/// Adds --domain and --interface.
void add_dds_options(const CliCommand& app, DdsSettings& settings);

/// Calls `work` and returns its exit code. Prints exceptions on stderr and returns kExitUsage for
/// ConfigError and std::invalid_argument, kExitFailure for all others.
int run_guarded(const std::string& name, const std::function<int()>& work);

}  // namespace sidestep
