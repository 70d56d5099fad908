// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <functional>

#include "common/config/scenario_loader.hpp"
#include "common/process/process.hpp"
#include "deploy/run.hpp"
#include "deploy/simulate.hpp"
#include "deploy/topic/topic_command.hpp"

namespace sidestep {
namespace {

void add_run_command(CLI::App& root, std::function<int()>& action, RunOptions& options) {
  CLI::App* command =
      root.add_subcommand("run", "Runs a scenario: one process for each part of the system, over DDS");
  command->add_option("SCENARIO", options.scenario_file, "scenario file, see deploy/scenarios/README.md")
      ->required();
  command->add_option("--report", options.report_file, "report file [reports/<scenario>-<time>.json]");
  command->add_option("--seed", options.seed, "of the simulator's noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seconds", options.seconds, "time limit instead of the scenario's")
      ->check(CLI::PositiveNumber);
  add_dds_options(*command, options.dds);
  command->callback([&] { action = [&options] { return run(options); }; });
}

void add_simulate_command(CLI::App& root, std::function<int()>& action, SimulateOptions& options) {
  CLI::App* command =
      root.add_subcommand("simulate", "Runs a scenario in one process and virtual time, repeatably");
  command->add_option("SCENARIO", options.scenario_file, "scenario file, see deploy/scenarios/README.md")
      ->required();
  command->add_option("--report", options.report_file, "report file [reports/<scenario>-<seed>.json]");
  command->add_option("--svg", options.picture_file, "draw the robots' ways into this file");
  command->add_option("--seed", options.seed, "of everything that is random")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seconds", options.seconds, "time limit instead of the scenario's")
      ->check(CLI::PositiveNumber);
  command->callback([&] { action = [&options] { return simulate(options); }; });
}

}  // namespace
}  // namespace sidestep

int main(int argc, char** argv) {
  using namespace sidestep;
  CLI::App app("Robots that share a floor move fast without touching.", "sidestep");
  app.require_subcommand(1);
  std::function<int()> action;
  RunOptions run_options;
  SimulateOptions simulate_options;
  run_options.dds.participant = "sidestep-run";
  add_run_command(app, action, run_options);
  add_simulate_command(app, action, simulate_options);
  add_topic_command(app, action);
  if (const int exit_code = parse_options(app, argc, argv); exit_code >= 0) return exit_code;
  try {
    return action();
  } catch (const ScenarioError& error) {
    fmt::print(stderr, "sidestep: {}\n", error.what());
    return kExitUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "sidestep: {}\n", error.what());
    return kExitFailure;
  }
}
