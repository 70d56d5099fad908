// SPDX-License-Identifier: Apache-2.0
#include "common/process/process.hpp"

#include <exception>
#include <fmt/core.h>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/rules_exchange.hpp"
#include "common/process/command_line.hpp"
#include "common/process/network_faults.hpp"
#include "common/process/stop_signals.hpp"

namespace sidestep {

void add_dds_options(const CliCommand& app, DdsSettings& settings) {
  app.add_option("--domain", settings.domain, "DDS domain, 0 .. 99").check(in_range(0, 99)).show_default();
  app.add_option("--interface", settings.interface, "address of the network interface to use, or 'all'")
      .show_default();
}

int run_guarded(const std::string& name, const std::function<int()>& work) {
  const auto report = [&name](const std::exception& error, int exit_code) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return exit_code;
  };
  try {
    return work();
  } catch (const ConfigError& error) {
    return report(error, kExitUsage);
  } catch (const std::invalid_argument& error) {
    return report(error, kExitUsage);
  } catch (const std::exception& error) {
    return report(error, kExitFailure);
  }
}

int run_process(int argc, char** argv, const Program& program) {
  CommandLine command_line(program.description, program.name);
  const CliCommand app = command_line.root();
  app.add_version("Fast DDS " + fast_dds_version());
  std::string scenario_file;
  DdsSettings dds;
  app.add_option("--scenario", scenario_file, "scenario file").required();
  add_dds_options(app, dds);
  app.add_flag("--faults", dds.faults, "accept `sidestep fault network`; for tests");
  if (program.add_options) program.add_options(app);
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;

  return run_guarded(program.name, [&] {
    const Scenario scenario = load_scenario(scenario_file);
    dds.participant = program.participant ? program.participant() : program.name;
    DdsBus bus(dds);
    const StopSignals stop_signals([&bus] { bus.stop(); });
    const RulesExchange rules(bus, program.process(), SharedRules(scenario), [&](const RulesMismatch& m) {
      fmt::print(stderr, "{}: {}\n", dds.participant, describe(m));
    });
    const std::shared_ptr<void> nodes = program.start(bus, scenario);
    if (dds.faults) apply_network_faults(bus, program.process(), dds.participant);
    fmt::print(stderr, "{}: Fast DDS {}, domain {}, listening on {}\n", dds.participant, fast_dds_version(),
               dds.domain, bus.locators());
    fmt::print(stderr, "{}: {}\n", dds.participant, budget_line(budget_of(scenario), scenario.margin_m));
    bus.run();
    return 0;
  });
}

}  // namespace sidestep
