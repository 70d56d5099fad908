// SPDX-License-Identifier: Apache-2.0
#include "common/process/process.hpp"

#include <algorithm>
#include <exception>
#include <fmt/core.h>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/log/log.hpp"
#include "common/messaging/dds/missing_interface.hpp"
#include "common/process/command_line.hpp"
#include "common/process/log_option.hpp"
#include "common/process/process_identity.hpp"
#include "common/process/process_run.hpp"
#include "common/version/version.hpp"

namespace sidestep {
namespace {

/// Calls `work` and returns its exit code. If it throws, reports the exception and returns the corresponding
/// exit code.
int run_reporting(const std::function<int()>& work, const std::function<void(const std::string&)>& report) {
  try {
    return work();
  } catch (const ConfigError& error) {
    report(error.what());
    return kExitUsage;
  } catch (const std::invalid_argument& error) {
    report(error.what());
    return kExitUsage;
  } catch (const std::exception& error) {
    report(error.what());
    return kExitFailure;
  }
}

}  // namespace

Incarnation next_incarnation(Incarnation previous, Time now) {
  const auto reading = static_cast<Incarnation>(to_ns(now));
  return is_plausible(previous + 1, now) ? std::max(reading, previous + 1) : reading;
}

void add_dds_options(const CliCommand& app, DdsSettings& settings) {
  app.add_option("--domain", settings.domain, "DDS domain").check(in_range(0, kMaxDomain)).show_default();
  add_dds_options_but_domain(app, settings);
}

void add_dds_options_but_domain(const CliCommand& app, DdsSettings& settings) {
  app.add_option("--interface", settings.interface, "address of the network interface to use, or 'all'")
      .show_default();
  app.add_option("--peers", settings.peers,
                 "addresses of the hosts of all processes, on networks without multicast [multicast]")
      .comma_separated();
  app.add_option("--keys", settings.keys,
                 "folder with the keys of this process, or a folder made by `sidestep keys init`");
  app.add_flag("--insecure", settings.insecure,
               "run without keys, although other machines can reach the interface and command the robots");
}

int run_and_report_errors(const std::string& name, const std::function<int()>& work) {
  const auto work_and_print = [&] {
    try {
      const int exit_code = work();
      finish_output();
      return exit_code;
    } catch (const MissingInterface& error) {
      throw std::invalid_argument(error.what());
    }
  };
  return run_reporting(work_and_print,
                       [&](const std::string& problem) { print_to(stderr, "{}: {}\n", name, problem); });
}

int run_process(int argc, char** argv, const Program& program) {
  CommandLine command_line(program.description, program.name);
  const CliCommand app = command_line.root();
  app.add_version(version_text(fast_dds_version()));
  std::string scenario_file;
  DdsSettings dds;
  LogLevel log_level = LogLevel::kInfo;
  const Option scenario_option =
      app.add_option("--scenario", scenario_file,
                     program.add_commands ? "scenario file; required without COMMAND" : "scenario file");
  // A required option would be required in front of a command, too.
  if (!program.add_commands) scenario_option.required();
  add_dds_options(app, dds);
  add_log_option(app, log_level);
  app.add_flag("--faults", dds.faults, "accept `sidestep fault network`; for tests");
  if (program.add_options) program.add_options(app);
  std::function<int()> action;
  if (program.add_commands) {
    program.add_commands(app, action);
    command_line.add_help_command();
  }
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  if (action) return run_and_report_errors(program.name, action);
  if (!scenario_option.is_given()) return command_line.refuse("--scenario is required");

  dds.participant = program.participant ? program.participant() : program.name;
  set_up_log(dds.participant, log_level);
  const auto work = [&] {
    const Scenario scenario = load_scenario(scenario_file);
    dds.identity = identity_of_process(program.process(), scenario);
    run_program(program, scenario, dds);
    return 0;
  };
  return run_reporting(work, [](const std::string& problem) { log(LogLevel::kError, problem); });
}

}  // namespace sidestep
