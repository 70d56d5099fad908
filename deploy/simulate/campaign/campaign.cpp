// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/campaign.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <thread>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "deploy/simulate/campaign/commit.hpp"
#include "deploy/simulate/campaign/results_file.hpp"
#include "deploy/simulate/campaign/scene_sampler.hpp"
#include "deploy/simulate/campaign/campaign_summary.hpp"
#include "deploy/simulate/campaign/trial.hpp"
#include "deploy/simulate/campaign/worker_pool.hpp"

namespace sidestep {
namespace {

using std::chrono::steady_clock;

constexpr auto kRedraw = std::chrono::milliseconds(500);
constexpr auto kPlainLine = std::chrono::seconds(10);

class Progress {
 public:
  Progress(std::uint64_t seeds, double hours_before) : seeds_(seeds), hours_before_(hours_before) {}

  void update(const SearchSummary& summary) {
    const auto now = steady_clock::now();
    if (now < next_) return;
    next_ = now + (is_terminal_ ? steady_clock::duration(kRedraw) : kPlainLine);
    const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
    const double hours = summary.robot_hours();
    fmt::print(
        stderr,
        "{}{} of {} seeds, {:.2f} robot-hours, {:.0f} robot-seconds a second, {} contacts, {} failed{}",
        is_terminal_ ? "\r\x1b[K" : "", summary.seeds(), seeds_, hours,
        elapsed_s > 0 ? (hours - hours_before_) * 3600 / elapsed_s : 0, summary.contacts(), summary.failed(),
        is_terminal_ ? "" : "\n");
  }
  /// Before something else is printed.
  void clear() const {
    if (is_terminal_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  bool is_terminal_ = isatty(STDERR_FILENO) == 1;
  std::uint64_t seeds_;
  double hours_before_;
  steady_clock::time_point begin_ = steady_clock::now();
  steady_clock::time_point next_ = begin_ + kRedraw;
};

std::string replay_command(const SearchOptions& options, std::uint64_t seed) {
  return fmt::format("sidestep simulate {}{}--faults draw --seconds {:g} --seed {}", options.scenario_file,
                     options.scenario_file.empty() ? "" : " ", to_seconds(options.duration), seed);
}

void print_failure(const SearchOptions& options, const std::optional<Scenario>& scenario,
                   const TrialResult& result) {
  fmt::print("seed {} failed at commit {}\n", result.seed, kCommit);
  for (const std::string& failure : result.failures) fmt::print("  {}\n", failure);
  const Trial trial = sample_trial(result.seed, options.duration, scenario);
  fmt::print("  drawn: {}\n", floor_in_words(trial.scenario));
  for (const std::string& line : in_words(trial.plan)) fmt::print("    {}\n", line);
  fmt::print("  again: {}\n", replay_command(options, result.seed));
  std::fflush(stdout);
}

/// The seeds whose results the file does not hold; takes over those that it does.
std::vector<std::uint64_t> seeds_left(const SearchOptions& options, std::optional<ResultsFile>& results,
                                      SearchSummary& summary) {
  std::set<std::uint64_t> done;
  if (!options.results_file.empty()) {
    results.emplace(options.results_file,
                    fmt::format("{} of {:g} s at commit {}",
                                options.scenario_file.empty() ? "drawn floors" : options.scenario_file,
                                to_seconds(options.duration), kCommit));
    for (const TrialResult& result : results->found()) {
      if (result.seed < options.first_seed || result.seed > options.last_seed) continue;
      if (done.insert(result.seed).second) summary.add(result);
    }
    if (!done.empty()) fmt::print("{}: holds {} of them\n", options.results_file, done.size());
  }
  std::vector<std::uint64_t> left;
  for (std::uint64_t seed = options.first_seed;; ++seed) {
    if (!done.contains(seed)) left.push_back(seed);
    if (seed == options.last_seed) return left;
  }
}

}  // namespace

int search_seeds(const SearchOptions& options) {
  std::optional<Scenario> scenario;
  if (!options.scenario_file.empty()) scenario = load_scenario(options.scenario_file);
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto begin = steady_clock::now();
  fmt::print("seeds {}..{}, {:g} s each, at commit {}\n", options.first_seed, options.last_seed,
             to_seconds(options.duration), kCommit);
  std::fflush(stdout);
  SearchSummary summary;
  std::optional<ResultsFile> results;
  const std::vector<std::uint64_t> left = seeds_left(options, results, summary);
  Progress progress(options.last_seed - options.first_seed + 1, summary.robot_hours());
  WorkerPool pool(
      options.jobs > 0 ? options.jobs : cores,
      [&](std::uint64_t seed) { return to_line(run_trial(sample_trial(seed, options.duration, scenario))); },
      [&](std::uint64_t seed, const std::string& line, const std::string& died) {
        TrialResult result;
        result.seed = seed;
        if (died.empty())
          result = result_from(line);
        else
          result.failures.push_back("the program died of it: " + died);
        summary.add(result);
        if (results) results->add(result);
        progress.clear();
        if (!result.failures.empty()) print_failure(options, scenario, result);
        progress.update(summary);
      });
  pool.run(left);
  progress.clear();
  fmt::print("{}{:.1f} s\n{}\n", summary.text(),
             std::chrono::duration<double>(steady_clock::now() - begin).count(),
             summary.failed() == 0 ? "passed" : "failed");
  if (!options.report_file.empty()) write_file(options.report_file, summary.json());
  return summary.failed() == 0 ? 0 : 1;
}

}  // namespace sidestep
