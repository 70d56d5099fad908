// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/campaign.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "common/version/version.hpp"
#include "deploy/trial/simulate/campaign/campaign_summary.hpp"
#include "deploy/trial/simulate/campaign/results_file.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "deploy/trial/simulate/campaign/trial_result.hpp"
#include "deploy/trial/simulate/campaign/worker_pool.hpp"

namespace sidestep {
namespace {

using std::chrono::steady_clock;

constexpr auto kTerminalPeriod = std::chrono::milliseconds(500);
constexpr auto kLinePeriod = std::chrono::seconds(10);

/// Progress on stderr: one line that is redrawn in a terminal, elsewhere one line every ten seconds. The most
/// important figures come first, because a narrow terminal shows only the beginning.
class CampaignProgress {
 public:
  /// `resumed_hours`: robot-hours taken from a results file.
  CampaignProgress(std::uint64_t seeds, double resumed_hours)
      : seeds_(seeds), resumed_hours_(resumed_hours) {}

  void update(const CampaignSummary& summary) {
    const auto now = steady_clock::now();
    if (now < next_) return;
    next_ = now + (can_redraw_ ? steady_clock::duration(kTerminalPeriod) : kLinePeriod);
    const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
    const double hours = summary.robot_hours();
    const std::string line = fmt::format(
        "{} of {} seeds, {} failed, {} contacts, {:.2f} robot-hours, {:.0f} robot-seconds per second",
        summary.seeds(), seeds_, summary.failed(), summary.contacts(), hours,
        elapsed_s > 0 ? (hours - resumed_hours_) * 3600 / elapsed_s : 0);
    print_to(stderr, "{}", can_redraw_ ? redrawn_line(line, STDERR_FILENO) : line + "\n");
  }
  /// Clears the line before other output.
  void clear() const {
    if (can_redraw_) print_to(stderr, "{}", kEraseLine);
  }

 private:
  bool can_redraw_ = terminal_of(STDERR_FILENO).can_redraw;
  std::uint64_t seeds_;
  double resumed_hours_;
  steady_clock::time_point begin_ = steady_clock::now();
  steady_clock::time_point next_ = begin_ + kTerminalPeriod;
};

std::string replay_command(const CampaignOptions& options, std::uint64_t seed) {
  return fmt::format("sidestep simulate {}{}--faults {} --seconds {:g} --seed {}", options.scenario_file,
                     options.scenario_file.empty() ? "" : " ", options.has_faults ? "random" : "none",
                     to_seconds(options.duration), seed);
}

void print_failure(const CampaignOptions& options, const std::optional<Scenario>& scenario,
                   const TrialResult& result) {
  print_to(stdout, "seed {} failed at commit {}\n", result.seed, kBuildCommit);
  for (const std::string& failure : result.failures) print_to(stdout, "  {}\n", failure);
  const Trial trial = sample_trial(result.seed, options.duration, scenario, options.has_faults);
  print_to(stdout, "  scene: {}\n", trial.summary());
  for (const std::string& line : to_lines(trial.plan)) print_to(stdout, "    {}\n", line);
  print_to(stdout, "  repeat with: {}\n", replay_command(options, result.seed));
}

/// Adds the results in the results file to the summary and returns the remaining seeds.
std::vector<std::uint64_t> remaining_seeds(const CampaignOptions& options,
                                           std::optional<ResultsFile>& results, CampaignSummary& summary) {
  std::set<std::uint64_t> done;
  if (!options.results_file.empty()) {
    results.emplace(
        options.results_file,
        fmt::format("{} of {:g} s, {} faults, at commit {}",
                    options.scenario_file.empty() ? "random scenes" : options.scenario_file,
                    to_seconds(options.duration), options.has_faults ? "random" : "no", kBuildCommit));
    for (const TrialResult& result : results->found()) {
      if (result.seed < options.first_seed || result.seed > options.last_seed) continue;
      if (done.insert(result.seed).second) summary.add(result);
    }
    if (!done.empty()) print_to(stdout, "{}: resuming after {} seeds\n", options.results_file, done.size());
  }
  std::vector<std::uint64_t> remaining;
  for (std::uint64_t seed = options.first_seed;; ++seed) {
    if (!done.contains(seed)) remaining.push_back(seed);
    if (seed == options.last_seed) return remaining;
  }
}

/// Adds a result to the file. If that fails, prints the reason and returns it, and the campaign continues
/// without the file, which keeps the earlier results.
std::string add_result(std::optional<ResultsFile>& results, const TrialResult& result) {
  try {
    results->add(result);
  } catch (const std::runtime_error& error) {
    results.reset();
    print_to(stderr, "{}; the campaign continues without it\n", error.what());
    return error.what();
  }
  return "";
}

}  // namespace

int run_campaign(const CampaignOptions& options) {
  std::optional<Scenario> scenario;
  if (!options.scenario_file.empty()) scenario = load_scenario(options.scenario_file);
  if (!options.report_file.empty()) require_replaceable(options.report_file);
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto begin = steady_clock::now();
  print_to(stdout, "seeds {}..{}, {:g} s each, at commit {}\n", options.first_seed, options.last_seed,
           to_seconds(options.duration), kBuildCommit);
  CampaignSummary summary;
  std::optional<ResultsFile> results;
  std::string results_problem;
  const std::vector<std::uint64_t> remaining = remaining_seeds(options, results, summary);
  CampaignProgress progress(options.last_seed - options.first_seed + 1, summary.robot_hours());
  WorkerPool pool(
      options.jobs > 0 ? options.jobs : cores,
      [&](std::uint64_t seed) {
        return to_line(run_trial(sample_trial(seed, options.duration, scenario, options.has_faults)));
      },
      [&](std::uint64_t seed, const std::string& line, const std::string& death_reason) {
        TrialResult result;
        result.seed = seed;
        if (death_reason.empty())
          result = parse_trial_result(line);
        else
          result.failures.push_back("the worker process died: " + death_reason);
        summary.add(result);
        progress.clear();
        if (results) results_problem = add_result(results, result);
        if (!result.failures.empty()) print_failure(options, scenario, result);
        progress.update(summary);
      });
  pool.run(remaining);
  progress.clear();
  print_to(stdout, "{}{:.1f} s\n{}\n", summary.text(),
           std::chrono::duration<double>(steady_clock::now() - begin).count(),
           summary.failed() == 0 ? "passed" : "failed");
  if (!options.report_file.empty()) write_file(options.report_file, summary.json());
  if (!results_problem.empty()) throw std::runtime_error(results_problem);
  return summary.failed() == 0 ? 0 : 1;
}

}  // namespace sidestep
