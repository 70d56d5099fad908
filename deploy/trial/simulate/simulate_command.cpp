// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/simulate_command.hpp"

#include <csignal>
#include <fmt/format.h>
#include <memory>
#include <string>

#include "common/config/planner_names.hpp"
#include "common/process/command_line.hpp"
#include "common/process/help/page_path.hpp"
#include "common/process/log_option.hpp"
#include "common/process/output_paths.hpp"
#include "deploy/trial/simulate/campaign/campaign.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "deploy/trial/simulate/seed_range.hpp"
#include "deploy/trial/simulate/simulate.hpp"

namespace sidestep {
namespace {

struct Options {
  std::string faults;
  SimulateOptions run;
  CampaignOptions campaign;
};

/// Parses the range of seeds. Throws UsageError if the text is invalid.
void read_seeds(const std::string& text, CampaignOptions& campaign) {
  const SeedRange seeds = parse_seed_range(text);
  campaign.first_seed = seeds.first;
  campaign.last_seed = seeds.last;
}

/// Throws UsageError if healthy systems may fail trials of this duration.
void check_duration(const Options& options) {
  const bool has_faults = options.faults != "none";
  const double min_s = to_seconds(min_trial_duration(has_faults));
  const double seconds = options.run.seconds.value_or(min_s);
  if (seconds >= min_s) return;
  const std::string reason =
      has_faults ? fmt::format("the last {:g} s have no faults, so that the system can recover",
                               to_seconds(kFaultFreeEnd))
                 : "robots need time to start";
  throw UsageError(fmt::format("--seconds: expected at least {:g} with --faults {}, got {:g}: {}", min_s,
                               options.faults, seconds, reason));
}

int run_seeds(Options& options) {
  require_separate_outputs(
      {{"SCENARIO", options.run.scenario_file}},
      {{"--report", options.run.report_file}, {"--results", options.campaign.results_file}});
  options.campaign.scenario_file = options.run.scenario_file;
  options.campaign.report_file = options.run.report_file;
  options.campaign.has_faults = options.faults != "none";
  if (options.run.seconds) options.campaign.duration = from_seconds(*options.run.seconds);
  return run_campaign(options.campaign);
}

}  // namespace

void add_simulate_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  SimulateOptions& run = options->run;
  CampaignOptions& campaign = options->campaign;
  const CliCommand command = root.add_subcommand(
      "simulate", "Runs a scenario in one process and virtual time; the same seed gives the same run");
  const Option scenario = command.add_option(
      "SCENARIO", run.scenario_file,
      "scenario file, see " + page_path("deploy/scenarios/README.md") + " [with --faults: a random scene]");
  command.add_option(
      "--report", run.report_file,
      "report file; an earlier file is replaced [reports/<scenario>-<seed>.json; with --seeds: none]");
  const Option svg = command.add_option(
      "--svg", run.picture_file,
      "draw the robots' paths to this SVG file, which plays in a browser; an earlier file is replaced");
  command.add_option("--sight", run.laser_robot, "draw what this robot's laser shows at the end instead")
      .check(non_negative())
      .needs(scenario)
      .needs(svg);
  const Option recording = command.add_option(
      "--record", run.recording_file, "record all messages to this file; an earlier file is replaced");
  const Option seed =
      command.add_option("--seed", run.seed, "random seed").check(non_negative()).show_default();
  command
      .add_option(
          "--seconds", run.seconds,
          "time limit [the scenario's]; with --faults: duration of a run [60], at least 24 with random "
          "faults, and 12 without")
      .check(positive());
  command.add_option("--planner", run.planner, "planner of all robots' paths [the scenario's]")
      .check(one_of(driving_planners()))
      .needs(scenario);
  const Option faults =
      command
          .add_option("--faults", options->faults,
                      "random: the seed determines random faults: network loss, delays, duplicates and "
                      "partitions, pauses and kills of processes, wrong clocks, and disturbances of robots; "
                      "none: a run of the same kind without faults")
          .check(one_of({"random", "none"}));
  const Option seeds =
      command
          .add_option(
              "--seeds", [&campaign](const std::string& text) { read_seeds(text, campaign); },
              "FIRST..LAST: a campaign of one run for each seed, on all cores")
          .needs(faults)
          .excludes(seed)
          .excludes(recording)
          .excludes(svg);
  command.add_option("--jobs", campaign.jobs, "parallel processes for --seeds [number of cores]")
      .check(in_range(1, 256))
      .needs(seeds);
  command
      .add_option("--results", campaign.results_file,
                  "file with one result per seed; an interrupted campaign resumes from it")
      .needs(seeds);
  const Option log_level = add_log_option(command, run.log_level);
  seeds.excludes(log_level);
  command.on_parsed([=, &action] {
    const bool has_faults = faults.is_given(), has_seeds = seeds.is_given();
    if (!has_faults && !scenario.is_given()) throw UsageError("SCENARIO is required");
    if (has_faults) check_duration(*options);
    action = [=] {
      // The report is written even if the reader of the output disappears.
      std::signal(SIGPIPE, SIG_IGN);
      if (has_seeds) return run_seeds(*options);
      return has_faults ? simulate_trial(options->run, options->faults != "none") : simulate(options->run);
    };
  });
}

}  // namespace sidestep
