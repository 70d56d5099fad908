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

/// The nodes of a process on a bus.
struct RunningNodes {
  std::shared_ptr<void> nodes;
  /// Whether the process works by its clock with others, so that it must keep it when the host's clock is
  /// set. Empty: never.
  std::function<bool()> uses_clock = {};
  /// Called when the process is asked to end, and then every 10 ms until it returns true. Only then does the
  /// process end. Empty: it ends at once.
  std::function<bool()> finish = {};
};

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
  /// std::invalid_argument for an option that does not fit the scenario. Called again, with a higher
  /// incarnation on a new bus, if the process begins anew by its host's clock.
  std::function<RunningNodes(DdsBus&, const Scenario&, Incarnation)> start;
  ClockReference clock_reference = ClockReference::kCoordinators;
};

/// The main function of a process on DDS: parses the options, loads the scenario, starts the program and runs
/// until SIGINT or SIGTERM. Returns the exit code. The log of the process is on stderr, in the name of the
/// participant.
int run_process(int argc, char** argv, const Program& program);

/// The incarnation of a process that begins now: a clock reading, above that of its previous run, unless
/// others would refuse the latter because it is too far ahead of the clock.
[[nodiscard]] Incarnation next_incarnation(Incarnation previous, Time now);

/// Adds --domain, --interface, --peers, --keys and --insecure.
void add_dds_options(const CliCommand& app, DdsSettings& settings);
void add_dds_options_but_domain(const CliCommand& app, DdsSettings& settings);

/// Calls `work` and returns its exit code. Prints exceptions on stderr and returns kExitUsage for
/// ConfigError and std::invalid_argument, kExitFailure for all others.
int run_guarded(const std::string& name, const std::function<int()>& work);

}  // namespace sidestep
