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
#include "common/motion/version.hpp"
#include "common/process/command_line.hpp"
#include "common/process/exit_code.hpp"
#include "common/process/host_clock_watch.hpp"

namespace sidestep {

/// The nodes of a process on its bus.
struct RunningNodes {
  std::shared_ptr<void> nodes;
  /// Whether other processes rely on this process's clock, so it must keep its clock when the host's clock is
  /// set. Empty: never.
  std::function<bool()> uses_clock = {};
  /// Called when the process is asked to exit, and then every 10 ms until it returns true; only then does the
  /// process exit, unless Ctrl-C repeats the request. Empty: it exits immediately.
  std::function<bool()> finish = {};
  /// Says what a process that exits before it has finished gives up, e.g. "robot 3 still moves"; empty text:
  /// nothing. Needed only with `finish`.
  std::function<std::string()> unfinished = {};
};

/// The program-specific parts of a process; run_process() provides the rest.
struct Program {
  std::string name;         ///< for example sidestep-agent
  std::string description;  ///< one sentence for --help
  /// Adds the program's own options. Empty: none.
  std::function<void(const CliCommand&)> add_options;
  /// Adds the program's commands, which set the action to carry out instead of the process. Empty: none.
  std::function<void(const CliCommand&, std::function<int()>& action)> add_commands;
  /// Returns the name of the DDS participant, which also names the process in its log, for example agent-3.
  /// Called after the options are parsed. Empty: `name`.
  std::function<std::string()> participant;
  /// Returns the process id (common/protocol/senders.hpp). Called after the options are parsed.
  std::function<std::uint32_t()> process;
  /// Creates the nodes on the bus; run_process() keeps them until the bus has stopped. May throw; it throws
  /// std::invalid_argument if an option does not fit the scenario. Called again, with a higher incarnation on
  /// a new bus, if the process restarts with its host's clock.
  std::function<RunningNodes(DdsBus&, const Scenario&, Incarnation)> start;
  ClockReference clock_reference = ClockReference::kCoordinators;
};

/// The main function of a process on DDS: parses the options, loads the scenario, starts the program and runs
/// until SIGINT or SIGTERM. Returns the exit code. The process logs to stderr under the participant's name.
/// If the command line contains one of the program's commands, carries that out instead.
int run_process(int argc, char** argv, const Program& program);

/// The incarnation of a process that starts now. It is a clock reading, and above the incarnation of the
/// previous run, unless such a number is so far ahead of the clock that other processes would refuse it.
[[nodiscard]] Incarnation next_incarnation(Incarnation previous, Time now);

/// Adds --domain, --interface, --peers, --keys and --insecure.
void add_dds_options(const CliCommand& app, DdsSettings& settings);
void add_dds_options_but_domain(const CliCommand& app, DdsSettings& settings);

/// Calls `work` and returns its exit code. Prints exceptions on stderr and returns kExitUsage for
/// ConfigError, std::invalid_argument and MissingInterface, kExitFailure for all others, and if stdout could
/// not be written.
int run_and_report_errors(const std::string& name, const std::function<int()>& work);

}  // namespace sidestep
