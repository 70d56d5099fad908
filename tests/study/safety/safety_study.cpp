// SPDX-License-Identifier: Apache-2.0
#include "tests/study/safety/safety_study.hpp"

#include <fmt/format.h>
#include <vector>

#include "tests/study/safety/search_time.hpp"
#include "tests/study/safety/traversal.hpp"
#include "tests/study/table/experiment.hpp"

namespace sidestep {
namespace {

struct SafetySizes {
  std::vector<int> robots{2, 4, 8, 16, 24, 32};
  int trials = 10;
  double seconds = 30;
  int margin_robots = 16, margin_trials = 5;
  double margin_seconds = 20;
  std::vector<double> margins_mm{0, 5, 10, 20};
  std::vector<double> noises_mm{0.5, 1, 2, 5, 10, 20};
  std::vector<int> searchers{2, 5, 10, 20, 50, 100, 200, 500, 1000};
  int search_trials = 100;
};
SafetySizes quick_safety_sizes() { return {{2, 16}, 2, 8, 16, 2, 8, {0, 10}, {0.5, 20}, {2, 20, 100}, 5}; }

std::string columns_of(const TraversalResult& r) {
  return fmt::format("{:.9f},{},{:.6f},{},{:.6f}", r.penetration_m_s, r.contacts, r.min_clearance_m,
                     r.traversals, r.reference_error_m);
}
/// The columns of a traversal run: the key's columns, then the measurements.
std::vector<std::string> traversal_columns(std::vector<std::string> columns) {
  for (const char* name :
       {"penetration_m_s", "contacts", "min_clearance_m", "traversals", "max_reference_error_m"})
    columns.emplace_back(name);
  return columns;
}

Experiment traversals(const StudyOptions& options, const SafetySizes& sizes) {
  Experiment experiment;
  experiment.table.name = "traversals";
  experiment.table.columns = traversal_columns({"mode", "robots", "seconds", "seed"});
  experiment.jobs = options.jobs;
  Plot& plot = experiment.table.plots.emplace_back();
  plot = {fmt::format("Left-right traversals, {} runs of {} s each", sizes.trials, sizes.seconds), "robots",
          "interpenetration, depth x time [m s]"};
  for (const bool has_search : {false, true}) {
    const std::string mode = has_search ? "with safety search" : "without";
    for (const int robots : sizes.robots) {
      for (int trial = 0; trial < sizes.trials; ++trial) {
        const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
        experiment.runs.push_back({mode, static_cast<double>(robots),
                                   cells(has_search ? "with" : "without", robots, sizes.seconds, seed),
                                   [=, seconds = sizes.seconds] {
                                     TraversalSettings settings;
                                     settings.robots = robots;
                                     const Scenario scenario = traversal_scenario(settings, seed);
                                     return columns_of(has_search
                                                           ? traverse_with_search(scenario, seed, seconds)
                                                           : traverse_without_search(scenario, seconds));
                                   }});
      }
    }
  }
  return experiment;
}

Experiment margins(const StudyOptions& options, const SafetySizes& sizes) {
  Experiment experiment;
  experiment.table.name = "margins";
  experiment.table.columns = traversal_columns(
      {"odometry", "off_reference_rule", "margin_mm", "noise_mm", "robots", "seconds", "seed"});
  experiment.jobs = options.jobs;
  Plot& plot = experiment.table.plots.emplace_back();
  plot = {fmt::format("Margins against noise: {} robots, poor odometry, {} runs of {} s each",
                      sizes.margin_robots, sizes.margin_trials, sizes.margin_seconds),
          "vision noise, standard deviation per axis [mm]", "interpenetration, depth x time [m s]"};
  plot.has_log_x = true;
  const auto add = [&](bool is_poor, bool stops_off_reference, double margin_mm, double noise_mm) {
    for (int trial = 0; trial < sizes.margin_trials; ++trial) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
      Run run;
      if (is_poor && !stops_off_reference) run.line = fmt::format("margin {} mm", margin_mm);
      run.x = noise_mm;
      run.key = cells(is_poor ? "poor" : "usual", stops_off_reference ? "on" : "off", margin_mm, noise_mm,
                      sizes.margin_robots, sizes.margin_seconds, seed);
      run.columns = [=, robots = sizes.margin_robots, seconds = sizes.margin_seconds] {
        const TraversalSettings settings{robots, margin_mm * 1e-3, noise_mm * 1e-3, is_poor,
                                         stops_off_reference};
        return columns_of(traverse_with_search(traversal_scenario(settings, seed), seed, seconds));
      };
      experiment.runs.push_back(std::move(run));
    }
  };
  for (const bool is_poor : {false, true}) {
    for (const double noise_mm : sizes.noises_mm) {
      for (const double margin_mm : sizes.margins_mm) add(is_poor, false, margin_mm, noise_mm);
      add(is_poor, true, TraversalSettings{}.margin_m * 1e3, noise_mm);
    }
  }
  return experiment;
}

Experiment search_times(const StudyOptions& options, const SafetySizes& sizes) {
  Experiment experiment;
  experiment.table.name = "search";
  experiment.table.columns = {"robots", "seed", "search_us_per_robot"};
  Plot& plot = experiment.table.plots.emplace_back();
  plot = {fmt::format("Safety search of one robot in one cycle, {} trials each", sizes.search_trials),
          "robots", "time per robot [us]"};
  plot.has_log_x = true;
  for (const int robots : sizes.searchers) {
    for (int trial = 0; trial < sizes.search_trials; ++trial) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
      experiment.runs.push_back({"0.7 m2 of floor per robot", static_cast<double>(robots),
                                 cells(robots, seed),
                                 [=] { return fmt::format("{:.3f}", search_us_per_robot(robots, seed)); }});
    }
  }
  return experiment;
}

}  // namespace

int study_safety(const StudyOptions& options) {
  require_study_output(options);
  const SafetySizes sizes = options.is_quick ? quick_safety_sizes() : SafetySizes{};
  for (Experiment& experiment :
       std::vector{traversals(options, sizes), margins(options, sizes), search_times(options, sizes)}) {
    measure(experiment);
    write_study_table(experiment.table, "safety", options);
  }
  return 0;
}

}  // namespace sidestep
