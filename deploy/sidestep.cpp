// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <functional>

#include "common/config/scenario_loader.hpp"
#include "common/process/process.hpp"
#include "deploy/monitor/audit/audit_command.hpp"
#include "deploy/evaluation/camera/frame_command.hpp"
#include "deploy/evaluation/camera/pattern_command.hpp"
#include "deploy/fault/fault_command.hpp"
#include "deploy/evaluation/planning/plan_command.hpp"
#include "deploy/launch/run.hpp"
#include "deploy/simulate/campaign/campaign.hpp"
#include "deploy/simulate/simulate.hpp"
#include "deploy/evaluation/study/study_command.hpp"
#include "deploy/monitor/topic/topic_command.hpp"

namespace sidestep {
namespace {

void add_run_command(CLI::App& root, std::function<int()>& action, RunOptions& options) {
  CLI::App* command =
      root.add_subcommand("run", "Runs a scenario: one process for each part of the system, over DDS");
  command->add_option("SCENARIO", options.scenario_file, "scenario file, see deploy/scenarios/README.md")
      ->required();
  command->add_option("--record", options.recording_file, "write all messages into this file");
  command->add_option("--report", options.report_file, "report file [reports/<scenario>-<time>.json]");
  command->add_option("--seed", options.seed, "of the simulator's noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seconds", options.seconds, "time limit instead of the scenario's")
      ->check(CLI::PositiveNumber);
  add_dds_options(*command, options.dds);
  command->add_flag("--faults", options.faults,
                    "let `sidestep fault network` disturb what arrives; for tests");
  command->add_option("--simulator", options.simulator,
                      "more options for sidestep-simulator, e.g. --simulator=\"--ssl-vision\"");
  command->add_option("--vision", options.vision,
                      "more options for sidestep-vision, e.g. --vision=\"--tracked --colours hall.yaml\"");
  command->add_option("--hosts", options.hosts_file, "hosts file, see deploy/launch/hosts/README.md")
      ->excludes(command->get_option("--interface"));
  command->callback([&] { action = [&options] { return run(options); }; });
}

/// "5..9" or "5".
std::string read_seeds(const std::string& text, SearchOptions& search) {
  std::size_t first = 0, last = 0;
  int end = 0;
  const bool is_range = std::sscanf(text.c_str(), "%zu..%zu%n", &first, &last, &end) == 2;
  if (!is_range || static_cast<std::size_t>(end) != text.size() || last < first) {
    return "expected FIRST..LAST, got \"" + text + "\"";
  }
  search.first_seed = first;
  search.last_seed = last;
  return {};
}

int simulate_or_search(const SimulateOptions& one, SearchOptions& many, bool samples_faults, bool is_many) {
  if (!is_many) return samples_faults ? simulate_trial(one) : simulate(one);
  many.scenario_file = one.scenario_file;
  many.report_file = one.report_file;
  if (one.seconds) many.duration = from_seconds(*one.seconds);
  return search_seeds(many);
}

void add_simulate_command(CLI::App& root, std::function<int()>& action, SimulateOptions& options,
                          SearchOptions& search) {
  CLI::App* command =
      root.add_subcommand("simulate", "Runs a scenario in one process and virtual time, repeatably");
  CLI::Option* scenario = command->add_option("SCENARIO", options.scenario_file,
                                              "scenario file, see deploy/scenarios/README.md; with --faults "
                                              "draw the floor is drawn where there is none");
  command->add_option("--report", options.report_file,
                      "report file [reports/<scenario>-<seed>.json; --seeds: none]");
  CLI::Option* svg =
      command->add_option("--svg", options.picture_file, "draw the robots' ways into this file");
  CLI::Option* recording =
      command->add_option("--record", options.recording_file, "write all messages into this file");
  CLI::Option* seed = command->add_option("--seed", options.seed, "of everything that is random")
                          ->check(CLI::NonNegativeNumber)
                          ->capture_default_str();
  command
      ->add_option("--seconds", options.seconds,
                   "time limit instead of the scenario's; with --faults draw the length of a run [60]")
      ->check(CLI::PositiveNumber);
  CLI::Option* faults =
      command
          ->add_option("--faults",
                       "draw: what goes wrong in the network and with processes is drawn from the seed")
          ->check(CLI::IsMember({"draw"}));
  CLI::Option* seeds = command
                           ->add_option_function<std::string>(
                               "--seeds",
                               [&search](const std::string& text) {
                                 if (const std::string why = read_seeds(text, search); !why.empty())
                                   throw CLI::ValidationError("--seeds", why);
                               },
                               "FIRST..LAST: one run for each seed, on all cores")
                           ->needs(faults)
                           ->excludes(seed)
                           ->excludes(recording)
                           ->excludes(svg);
  command->add_option("--jobs", search.jobs, "processes for --seeds [as many as there are cores]")
      ->check(CLI::PositiveNumber)
      ->needs(seeds);
  command
      ->add_option("--results", search.results_file,
                   "file of the seeds' results; a search that was stopped goes on where it was")
      ->needs(seeds);
  command->callback([=, &action, &options, &search] {
    const bool samples_faults = faults->count() > 0, is_many = seeds->count() > 0;
    if (!samples_faults && scenario->count() == 0) throw CLI::RequiredError("SCENARIO");
    action = [=, &options, &search] { return simulate_or_search(options, search, samples_faults, is_many); };
  });
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
  SearchOptions search_options;
  run_options.dds.participant = "sidestep-run";
  add_run_command(app, action, run_options);
  add_simulate_command(app, action, simulate_options, search_options);
  add_topic_command(app, action);
  add_fault_command(app, action);
  add_study_command(app, action);
  add_audit_commands(app, action);
  add_plan_commands(app, action);
  add_frame_command(app, action);
  add_pattern_command(app, action);
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
