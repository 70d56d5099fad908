// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/dds/dds_bus.hpp"

namespace CLI {
class App;
}

namespace sidestep {

/// Wrong usage or a wrong scenario, and a failure at run time; success is 0.
inline constexpr int kExitUsage = 2;
inline constexpr int kExitFailure = 1;

/// What is particular to one of our programs; all others share the rest by run_process().
struct Program {
  std::string name;         ///< as typed, e.g. sidestep-agent; stands before every message
  std::string description;  ///< one sentence for --help
  /// Adds the program's own options, beside --scenario, --domain and --interface. May be empty.
  std::function<void(CLI::App&)> add_options;
  /// The name that listeners see, called once the options are parsed, e.g. agent-3. Empty: `name`.
  std::function<std::string()> participant;
  /// Who `sidestep fault network` reaches it as (common/messaging/senders.hpp), once the options are parsed.
  std::function<std::uint32_t()> fault_target;
  /// Makes the nodes on the bus. What it returns lives until the bus has stopped. May throw;
  /// std::invalid_argument for an option that does not fit the scenario.
  std::function<std::shared_ptr<void>(DdsBus&, const Scenario&)> start;
};

/// The main of a process on DDS: parses, loads the scenario, starts and runs until SIGINT or SIGTERM. Returns
/// the exit code; says on stderr what is wrong, as "NAME: message".
int run_process(int argc, char** argv, const Program& program);

/// Adds --domain and --interface.
void add_dds_options(CLI::App& app, DdsSettings& settings);

/// Adds an option that turns something on and whose value may be left out: then it is the default.
void add_optional_value(CLI::App& app, const std::string& name, std::optional<std::string>& value,
                        const std::string& default_value, const std::string& description);

/// Runs a program's work, and says on stderr what is wrong when it throws: kExitUsage for ScenarioError and
/// std::invalid_argument, kExitFailure for everything else.
int guarded(const std::string& name, const std::function<int()>& work);

/// Parses; an exit code when the program is done with that (--help: 0; wrong usage: kExitUsage), else -1.
int parse_options(CLI::App& app, int argc, char** argv);

}  // namespace sidestep
