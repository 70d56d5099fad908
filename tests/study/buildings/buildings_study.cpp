// SPDX-License-Identifier: Apache-2.0
#include "tests/study/buildings/buildings_study.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_loader.hpp"
#include "tests/study/buildings/building_run_dds.hpp"
#include "tests/study/table/experiment.hpp"

namespace sidestep {
namespace {

constexpr double kQuickSeconds = 20;
constexpr const char *kVerdict = "verdict", *kGood = "good";

Experiment experiment_of(const StudyOptions& options) {
  Experiment experiment;
  experiment.jobs = options.jobs;
  StudyTable& table = experiment.table;
  table.name = "buildings";
  table.columns = {"scenario",    "planner",    "seed",          "reached",        "orders",
                   "blocked",     "stuck",      "contacts",      "crashes",        "crashes_in_motion",
                   "longest_s",   "distance_m", "route_changes", "missed_percent", "plan_p99_us",
                   "plan_max_us", kVerdict};
  table.plots.push_back({"goals that robots reach", "scenario", "goals"});
  return experiment;
}

std::string columns_of(const BuildingResult& r) {
  return fmt::format("{},{},{},{},{},{},{},{:.1f},{:.0f},{},{:.2f},{:.0f},{:.0f},{}", r.trips.reached,
                     r.trips.orders, r.trips.blocked, r.trips.stuck, r.contacts, r.crashes,
                     r.crashes_in_motion, r.trips.longest_s, r.distance_m, r.route_changes, r.missed_percent,
                     r.plan_p99_us, r.plan_max_us, r.is_good() ? kGood : "not good");
}

void add_runs(Experiment& experiment, const std::string& file, const BuildingsOptions& options) {
  const Scenario scenario = load_scenario(file);
  std::vector<std::string>& categories = experiment.table.plots.front().categories;
  const auto number = static_cast<double>(categories.size());
  categories.push_back(scenario.name);
  const Duration duration = from_seconds(options.study.is_quick ? kQuickSeconds : options.seconds);
  for (const std::string& planner : options.planners) {
    Scenario driven = scenario;
    use_planner(driven, planner);
    for (int trial = 0; trial < (options.study.is_quick ? 1 : options.trials); ++trial) {
      const std::uint64_t seed = options.study.seed + static_cast<std::uint64_t>(trial);
      const BuildingRunOverDds over_dds{file, planner, options.study.folder, duration, seed};
      const auto result = [=, is_over_dds = options.over_dds] {
        return is_over_dds ? run_building(over_dds) : run_building(driven, duration, seed);
      };
      experiment.runs.push_back(
          {planner, number, cells(scenario.name, planner, seed), [=] { return columns_of(result()); }});
    }
  }
}

}  // namespace

int study_buildings(const BuildingsOptions& options) {
  Experiment experiment = experiment_of(options.study);
  for (const std::string& file : options.scenario_files) add_runs(experiment, file, options);
  require_study_output(options.study);
  measure(experiment);
  fmt::print("{}", markdown_of(experiment.table));
  const std::string command = fmt::format(
      "buildings {} --planner {} --seconds {} --trials {}{}", fmt::join(options.scenario_files, " "),
      fmt::join(options.planners, ","), options.seconds, options.trials, options.over_dds ? " --dds" : "");
  write_study_table(experiment.table, command, options.study);
  const bool is_good =
      std::ranges::all_of(experiment.table.rows, [](const auto& row) { return row.back() == kGood; });
  return is_good ? 0 : 1;
}

}  // namespace sidestep
