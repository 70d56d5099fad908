// SPDX-License-Identifier: Apache-2.0
#include "common/process/process.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <fmt/core.h>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/process/network_faults.hpp"
#include "common/process/stop_signals.hpp"

namespace sidestep {

void add_dds_options(CLI::App& app, DdsSettings& settings) {
  app.add_option("--domain", settings.domain, "DDS domain, 0 .. 99")
      ->check(CLI::Range(0, 99))
      ->capture_default_str();
  app.add_option("--interface", settings.interface, "address of the network interface to use, or 'all'")
      ->capture_default_str();
}

void add_optional_value(CLI::App& app, const std::string& name, std::optional<std::string>& value,
                        const std::string& default_value, const std::string& description) {
  const auto take = [&value, default_value](const std::vector<std::string>& given) {
    const bool is_left_out = given.empty() || given.front().empty();
    value = is_left_out ? default_value : given.front();
  };
  app.add_option_function<std::vector<std::string>>(name, take,
                                                    fmt::format("{} [{}]", description, default_value))
      ->expected(0, 1);
}

int parse_options(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  return -1;
}

int guarded(const std::string& name, const std::function<int()>& work) {
  const auto said = [&name](const std::exception& error, int exit_code) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return exit_code;
  };
  try {
    return work();
  } catch (const ScenarioError& error) {
    return said(error, kExitUsage);
  } catch (const std::invalid_argument& error) {
    return said(error, kExitUsage);
  } catch (const std::exception& error) {
    return said(error, kExitFailure);
  }
}

int run_process(int argc, char** argv, const Program& program) {
  CLI::App app(program.description, program.name);
  std::string scenario_file;
  DdsSettings dds;
  app.add_option("--scenario", scenario_file, "scenario file")->required();
  add_dds_options(app, dds);
  app.add_flag("--faults", dds.faults, "let `sidestep fault network` disturb what arrives; for tests");
  if (program.add_options) program.add_options(app);
  const int exit_code = parse_options(app, argc, argv);
  if (exit_code >= 0) return exit_code;

  return guarded(program.name, [&] {
    const Scenario scenario = load_scenario(scenario_file);
    dds.participant = program.participant ? program.participant() : program.name;
    DdsBus bus(dds);
    const StopSignals stop_signals([&bus] { bus.stop(); });
    const std::shared_ptr<void> nodes = program.start(bus, scenario);
    if (dds.faults) take_network_faults(bus, program.fault_target(), dds.participant);
    fmt::print(stderr, "{}: domain {}, listens on {}\n", dds.participant, dds.domain, bus.locators());
    fmt::print(stderr, "{}: {}\n", dds.participant, budget_line(budget_of(scenario), scenario.margin_m));
    bus.run();
    return 0;
  });
}

}  // namespace sidestep
