// SPDX-License-Identifier: Apache-2.0
#include "tests/study/table/experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "deploy/trial/simulate/campaign/worker_pool.hpp"

namespace sidestep {
namespace {

/// Measures all runs, each in its own process.
std::vector<std::string> results_of(const Experiment& experiment) {
  const std::vector<Run>& runs = experiment.runs;
  std::vector<std::string> results(runs.size());
  std::string failure;
  std::size_t done = 0;
  StudyProgress progress(experiment.table.name);
  WorkerPool pool(
      experiment.jobs, [&](std::uint64_t job) { return runs[job].columns(); },
      [&](std::uint64_t job, const std::string& line, const std::string& died) {
        if (!died.empty()) failure = fmt::format("{}: {}", fmt::join(runs[job].key, ","), died);
        results[job] = line;
        progress(++done, runs.size());
      });
  std::vector<std::uint64_t> jobs(runs.size());
  std::iota(jobs.begin(), jobs.end(), 0);
  pool.run(jobs);
  if (!failure.empty()) throw std::runtime_error("a run ended abnormally: " + failure);
  return results;
}

void fill_in(Experiment& experiment, const std::vector<std::string>& results) {
  std::vector<std::string> titles;
  std::map<std::string, std::map<double, std::vector<double>>> values;
  for (std::size_t i = 0; i < experiment.runs.size(); ++i) {
    const Run& run = experiment.runs[i];
    std::vector<std::string>& row = experiment.table.rows.emplace_back(run.key);
    std::istringstream line(results[i]);
    for (std::string cell; std::getline(line, cell, ',');) row.push_back(cell);
    if (run.line.empty()) continue;
    if (!values.contains(run.line)) titles.push_back(run.line);
    values[run.line][run.x].push_back(std::stod(results[i]));
  }
  for (const std::string& title : titles) {
    PlotLine& line = experiment.table.plots.front().lines.emplace_back(PlotLine{title, {}});
    for (const auto& [x, trials] : values[title]) line.points.push_back(plot_point(x, trials));
  }
}

}  // namespace

void measure(Experiment& experiment) { fill_in(experiment, results_of(experiment)); }

}  // namespace sidestep
