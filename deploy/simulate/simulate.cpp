// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/process/process.hpp"
#include "deploy/simulate/run_picture.hpp"
#include "deploy/monitor/metrics/progress.hpp"
#include "deploy/monitor/record/recording.hpp"
#include "deploy/simulate/campaign/commit.hpp"
#include "deploy/simulate/campaign/scene_sampler.hpp"
#include "deploy/simulate/campaign/campaign.hpp"
#include "deploy/simulate/campaign/trial.hpp"
#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

using std::chrono::steady_clock;

constexpr Duration kStartDeadline = std::chrono::seconds(20);
constexpr Duration kLook = std::chrono::milliseconds(100);
constexpr auto kRedraw = std::chrono::milliseconds(250);

/// On stderr and in terminals only: what goes to stdout is the summary.
class Ticker {
 public:
  void update(const SimSystem& system) {
    if (!is_terminal_ || steady_clock::now() < next_) return;
    next_ = steady_clock::now() + kRedraw;
    fmt::print(stderr, "\r\x1b[K{}", progress_line(system.judge(), system.now()));
  }
  ~Ticker() {
    if (is_terminal_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  bool is_terminal_ = isatty(STDERR_FILENO) == 1;
  steady_clock::time_point next_{};
};

/// Why the run ended early; empty: it did not.
std::string drive(SimSystem& system, double limit_s) {
  Ticker ticker;
  while (!system.judge().granting_since()) {
    if (system.now() >= system.begin() + kStartDeadline) {
      return fmt::format("the coordinator does not grant after {} s", to_seconds(kStartDeadline));
    }
    system.run_for(kLook);
    ticker.update(system);
  }
  const Time limit = *system.judge().granting_since() + from_seconds(limit_s);
  while (system.now() < limit) {
    if (system.run_until_arrived(std::min(limit, system.now() + kLook))) return "";
    ticker.update(system);
  }
  return system.judge().all_arrived() ? "" : fmt::format("time limit of {} s", limit_s);
}

/// Writes all messages of a system into a file, if one is asked for. Completeness is about what makes and
/// follows versions: nothing of that is said while a system is made.
class SimRecorder {
 public:
  SimRecorder(SimNetwork& network, const Scenario& scenario, const SimulateOptions& options) : bus_(network) {
    if (options.recording_file.empty()) return;
    RecordingHead head;
    head.scenario = scenario.name;
    if (!options.scenario_file.empty()) head = recording_head(scenario.name, options.scenario_file);
    head.is_complete = true;
    writer_.emplace(options.recording_file, head);
    bus_.listen_aside();
    record(bus_, scenario, *writer_);
  }
  /// Throws std::runtime_error when not everything could be written.
  void close() {
    if (writer_) writer_->close();
  }

 private:
  std::optional<RecordingWriter> writer_;
  SimBus bus_;
};

/// Completes and writes the report, prints it, and returns the exit code.
int conclude(const SimulateOptions& options, Report& report, const Picture& picture,
             steady_clock::time_point begin) {
  report.program = "simulate";
  report.seed = options.seed;
  report.duration_s = std::chrono::duration<double>(steady_clock::now() - begin).count();
  const std::string path =
      options.report_file.empty() ? default_report_path(report.scenario, options.seed) : options.report_file;
  write_report(report, path);
  if (!options.picture_file.empty()) write_file(options.picture_file, picture.svg());
  fmt::print("{}, seed {}: {}{:.1f} times as fast as real time\nreport: {}\n", report.scenario, options.seed,
             summary(report), report.duration_s > 0 ? report.robot_time_s / report.duration_s : 0.0, path);
  return report.verdict().empty() ? 0 : kExitFailure;
}

}  // namespace

int simulate_trial(const SimulateOptions& options) {
  const auto begin = steady_clock::now();
  std::optional<Scenario> scenario;
  if (!options.scenario_file.empty()) scenario = load_scenario(options.scenario_file);
  const Duration duration = options.seconds ? from_seconds(*options.seconds) : SearchOptions{}.duration;
  const Trial trial = sample_trial(options.seed, duration, scenario);
  fmt::print("commit {}\n{}\n", kCommit, floor_in_words(trial.scenario));
  for (const std::string& line : in_words(trial.plan)) fmt::print("  {}\n", line);
  Picture picture(trial.scenario);
  Report report;
  std::optional<SimRecorder> recorder;
  run_trial(
      trial, &report,
      [&](const msg::GroundTruth& truth) {
        if (!options.picture_file.empty()) picture.add(truth);
      },
      [&](SimSystem& system) { recorder.emplace(system.network(), trial.scenario, options); },
      [&] { recorder->close(), recorder.reset(); });
  return conclude(options, report, picture, begin);
}

int simulate(const SimulateOptions& options) {
  const Scenario scenario = load_scenario(options.scenario_file);
  fmt::print(stderr, "{}\n", budget_line(budget_of(scenario), scenario.margin_m));
  const auto begin = steady_clock::now();
  SimSystem system(scenario, options.seed);
  Picture picture(scenario);
  if (!options.picture_file.empty())
    system.on_truth([&](const msg::GroundTruth& truth) { picture.add(truth); });
  SimRecorder recorder(system.network(), scenario, options);
  const std::string failure = drive(system, options.seconds.value_or(scenario.time_limit_s));
  recorder.close();
  Report report = system.judge().report();
  report.failure = failure;
  return conclude(options, report, picture, begin);
}

}  // namespace sidestep
