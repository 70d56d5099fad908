// SPDX-License-Identifier: Apache-2.0
#include "tests/study/clutter/clutter_study.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/config/planner_names.hpp"
#include "tests/study/clutter/clutter_scene.hpp"
#include "tests/study/clutter/clutter_summary.hpp"
#include "tests/study/table/experiment.hpp"

namespace sidestep {
namespace {

struct ClutterSizes {
  std::vector<std::string> planners = driving_planners();
  std::vector<int> people{5, 10, 20, 40, 60};
  int hall_trials = 5;
  int building_robots = 6, building_people = 8, building_trials = 5;
};
ClutterSizes quick_clutter_sizes() { return {{"lazy-visibility", "errt"}, {5}, 1, 2, 2, 1}; }

// Columns that must be zero.
constexpr const char *kContacts = "contacts", *kCrashesInMotion = "crashes_in_motion";
constexpr const char *kAudit = "audit", *kPassed = "passed";

Experiment experiment_of(const char* name, const StudyOptions& options) {
  Experiment experiment;
  experiment.jobs = options.jobs;
  experiment.table.name = name;
  experiment.table.columns = {"planner", "robots",  "people",  "seed",           "seconds",
                              "arrived", kContacts, "crashes", kCrashesInMotion, kAudit};
  experiment.table.plots.push_back({fmt::format("{}: time until all goals are reached", name), "people",
                                    "time [s], 300 if not all arrived"});
  return experiment;
}

void add_run(Experiment& experiment, const ClutterSettings& settings, std::uint64_t seed) {
  experiment.runs.push_back({settings.planner, static_cast<double>(settings.people),
                             cells(settings.planner, settings.robots, settings.people, seed), [=] {
                               const ClutterResult r = run_clutter(clutter_scene(settings, seed), seed);
                               return fmt::format("{:.3f},{},{},{},{},{}", r.seconds, r.arrived, r.contacts,
                                                  r.crashes, r.crashes_in_motion,
                                                  r.audit_passed ? kPassed : "not passed");
                             }});
}

bool is_safe(const StudyTable& table) {
  return std::ranges::all_of(table.rows, [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string& column = table.columns[i];
      if ((column == kContacts || column == kCrashesInMotion) && row[i] != "0") return false;
      if (column == kAudit && row[i] != kPassed) return false;
    }
    return true;
  });
}

}  // namespace

int study_clutter(const StudyOptions& options, const std::vector<std::string>& planners) {
  require_study_output(options);
  ClutterSizes sizes = options.is_quick ? quick_clutter_sizes() : ClutterSizes{};
  if (!planners.empty()) sizes.planners = planners;
  Experiment people = experiment_of("people", options), buildings = experiment_of("buildings", options);
  for (const std::string& planner : sizes.planners) {
    const auto seed = [&](int trial) { return options.seed + static_cast<std::uint64_t>(trial); };
    for (const int count : sizes.people)
      for (int trial = 0; trial < sizes.hall_trials; ++trial)
        add_run(people, {false, 1, count, planner}, seed(trial));
    for (int trial = 0; trial < sizes.building_trials; ++trial)
      add_run(buildings, {true, sizes.building_robots, sizes.building_people, planner}, seed(trial));
  }
  bool all_safe = true;
  for (Experiment* experiment : {&people, &buildings}) {
    measure(*experiment);
    const StudyTable summary = clutter_summary(experiment->table);
    experiment->table.plots.push_back(success_plot(summary));
    fmt::print("{}", markdown_of(summary));
    const std::string only = planners.empty() ? "" : fmt::format(" --planner {}", fmt::join(planners, ","));
    write_study_table(experiment->table, "clutter" + only, options);
    all_safe = all_safe && is_safe(experiment->table);
  }
  return all_safe ? 0 : 1;
}

}  // namespace sidestep
