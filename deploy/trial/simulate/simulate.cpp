// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/log/log.hpp"
#include "common/process/command_line.hpp"
#include "common/process/output_paths.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "common/version/version.hpp"
#include "deploy/audit/metrics/progress.hpp"
#include "deploy/audit/picture/run_picture.hpp"
#include "deploy/inspect/record/recording.hpp"
#include "deploy/trial/simulate/campaign/campaign.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "deploy/trial/simulate/laser_picture.hpp"
#include "deploy/trial/simulate/system/sim_log.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

using std::chrono::steady_clock;

constexpr Duration kStartupTimeout = std::chrono::seconds(20);
constexpr Duration kStep = std::chrono::milliseconds(100);
constexpr auto kDisplayPeriod = std::chrono::milliseconds(250);

std::string report_path(const SimulateOptions& options, const std::string& scenario) {
  return options.report_file.empty() ? default_report_path(scenario, options.seed) : options.report_file;
}

/// Throws UsageError if an output would overwrite another file of the run, and std::runtime_error if one
/// cannot be written.
void check_paths(const SimulateOptions& options, const std::string& scenario) {
  const std::string report = report_path(options, scenario);
  require_separate_outputs(
      {{"SCENARIO", options.scenario_file}},
      {{"--report", report}, {"--record", options.recording_file}, {"--svg", options.picture_file}});
  require_replaceable(report);
  if (!options.recording_file.empty()) require_openable(options.recording_file);
  if (!options.picture_file.empty()) require_replaceable(options.picture_file);
}

/// Shows the progress line on stderr if that is a terminal; stdout is for the summary.
class ProgressLine {
 public:
  void update(const SimSystem& system) {
    if (!is_shown_ || steady_clock::now() < next_) return;
    next_ = steady_clock::now() + kDisplayPeriod;
    print_to(stderr, "{}", redrawn_line(progress_line(system.metrics(), system.now()), STDERR_FILENO));
  }
  ~ProgressLine() {
    if (is_shown_) print_to(stderr, "{}", kEraseLine);
  }

 private:
  bool is_shown_ = terminal_of(STDERR_FILENO).can_redraw;
  steady_clock::time_point next_{};
};

/// Runs the system until all robots have arrived. Returns why the run was aborted; empty: it was not aborted.
std::string run_until_arrived(SimSystem& system, double limit_s) {
  ProgressLine progress;
  while (!system.metrics().granting_since()) {
    if (system.now() >= system.begin() + kStartupTimeout) {
      return fmt::format("the coordinator did not grant within {} s", to_seconds(kStartupTimeout));
    }
    system.run_for(kStep);
    progress.update(system);
  }
  const Time limit = *system.metrics().granting_since() + from_seconds(limit_s);
  while (system.now() < limit) {
    if (system.run_until_arrived(std::min(limit, system.now() + kStep))) return "";
    progress.update(system);
  }
  return system.metrics().all_arrived() ? "" : fmt::format("time limit of {} s", limit_s);
}

/// Records all messages of a system if a file is given. The recording counts as complete although it misses
/// the construction of the system: during construction no message about versions is sent.
class SimRecorder {
 public:
  explicit SimRecorder(const SimulateOptions& options) : options_(options) {}

  void start(SimNetwork& network, const Scenario& scenario) {
    if (options_.recording_file.empty()) return;
    RecordingHeader header;
    header.scenario_name = scenario.name;
    if (!options_.scenario_file.empty()) header = recording_header(scenario, options_.scenario_file);
    header.is_complete = true;
    writer_.emplace(options_.recording_file, header);
    writer_->on_failure([](const std::string& failure) { log(LogLevel::kError, "recording: " + failure); });
    bus_.emplace(network);
    bus_->become_observer();
    record(*bus_, scenario, *writer_);
  }
  /// Stops recording. Must be called while the network exists.
  void stop() {
    if (bus_) stopped_at_ = bus_->now();
    bus_.reset();
  }
  /// Why messages could not be recorded; empty: there was no problem.
  std::string failure() const { return writer_ ? writer_->failure() : ""; }
  /// Adds the report to the recording and closes it. If that fails, adds the reason to the report.
  void close(Report& report) {
    if (!writer_) return;
    writer_->add_report(stopped_at_, to_json(report));
    try {
      writer_->close();
    } catch (const std::runtime_error& error) {
      report.recording_failure = error.what();
    }
  }

 private:
  const SimulateOptions& options_;
  std::optional<RecordingWriter> writer_;
  std::optional<SimBus> bus_;
  Time stopped_at_{};
};

/// Listens to the scans of one robot for a picture, if the options ask for one.
class LaserPictureRecorder {
 public:
  /// Throws UsageError if the robot does not exist or has no laser.
  LaserPictureRecorder(SimSystem& system, const Scenario& scenario, const SimulateOptions& options)
      : bus_(system.network()) {
    if (!options.laser_robot) return;
    try {
      picture_.emplace(scenario, *options.laser_robot);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--sight: ") + error.what());
    }
    bus_.become_observer();
    bus_.observe<msg::LaserScan>(topics::kScan, *options.laser_robot,
                                 [this](const msg::LaserScan& scan) { picture_->add(scan); });
    system.observer_bus().subscribe(topics::kTruth,
                                    [this](const msg::GroundTruth& truth) { picture_->add(truth); });
  }
  /// The picture; nullptr if none was requested.
  const LaserPicture* picture() const { return picture_ ? &*picture_ : nullptr; }

 private:
  std::optional<LaserPicture> picture_;
  SimBus bus_;
};

/// Completes, prints and writes the report, draws the run or the picture of a laser, and returns the exit
/// code. Prints it first, because writing may fail.
int finish(const SimulateOptions& options, Report& report, SimRecorder& recorder,
           steady_clock::time_point begin, const LaserPicture* laser = nullptr) {
  report.program = "simulate";
  report.seed = options.seed;
  report.duration_s = std::chrono::duration<double>(steady_clock::now() - begin).count();
  report.recording_failure = recorder.failure();
  const std::string text = summary(report);
  const double speed = report.duration_s > 0 ? report.robot_time_s / report.duration_s : 0.0;
  print_to(stdout, "{}, seed {}: {}{:.1f} times as fast as real time\n", report.scenario, options.seed,
           terminal_of(STDOUT_FILENO).has_colours ? with_coloured_verdict(text, report.verdict()) : text,
           speed);
  const bool had_failed = !report.recording_failure.empty();
  recorder.close(report);
  if (!had_failed && !report.recording_failure.empty())
    print_to(stdout, "failed: {}\n", report.failure_reason());
  const std::string path = report_path(options, report.scenario);
  const std::string problem = try_write_report(report, path);
  if (problem.empty()) print_to(stdout, "report: {}\n", path);
  std::string drawing;
  if (!options.picture_file.empty())
    drawing = try_write_file(options.picture_file, laser ? laser->svg() : run_picture_from(to_json(report)));
  require_written({problem, drawing});
  return exit_code(report.verdict());
}

Scenario scenario_of(const SimulateOptions& options) {
  Scenario scenario = load_scenario(options.scenario_file);
  use_planner(scenario, options.planner);
  return scenario;
}

}  // namespace

int simulate_trial(const SimulateOptions& options, bool has_faults) {
  const auto begin = steady_clock::now();
  std::optional<Scenario> scenario;
  if (!options.scenario_file.empty()) scenario = scenario_of(options);
  const Duration duration = options.seconds ? from_seconds(*options.seconds) : CampaignOptions{}.duration;
  const Trial trial = sample_trial(options.seed, duration, scenario, has_faults);
  check_paths(options, trial.scenario.name);
  print_to(stdout, "commit {}\n{}\n", kBuildCommit, trial.summary());
  for (const std::string& line : to_lines(trial.plan)) print_to(stdout, "  {}\n", line);
  Report report;
  SimRecorder recorder(options);
  TrialHooks hooks;
  hooks.on_start = [&](SimSystem& system) {
    log_events_of(system, options.log_level);
    recorder.start(system.network(), trial.scenario);
  };
  hooks.on_end = [&] { recorder.stop(); };
  run_trial(trial, &report, hooks);
  return finish(options, report, recorder, begin);
}

int simulate(const SimulateOptions& options) {
  const Scenario scenario = scenario_of(options);
  check_paths(options, scenario.name);
  print_to(stderr, "{}\n", budget_line(budget_of(scenario), scenario.margin_m));
  if (scenario.map && !scenario.map->notice().empty()) print_to(stderr, "{}\n", scenario.map->notice());
  if (scenario.has_test_keys)
    print_to(stderr, "faults and expectations in {} apply to `sidestep test` only\n", options.scenario_file);
  const auto begin = steady_clock::now();
  SimSystem system(scenario, options.seed);
  log_events_of(system, options.log_level);
  LaserPictureRecorder sight(system, scenario, options);
  SimRecorder recorder(options);
  recorder.start(system.network(), scenario);
  const std::string abort_reason = run_until_arrived(system, options.seconds.value_or(scenario.time_limit_s));
  recorder.stop();
  Report report = system.metrics().report();
  report.trace = system.metrics().floor_trace();
  report.abort_reason = abort_reason;
  return finish(options, report, recorder, begin, sight.picture());
}

}  // namespace sidestep
