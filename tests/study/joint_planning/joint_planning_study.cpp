// SPDX-License-Identifier: Apache-2.0
#include "tests/study/joint_planning/joint_planning_study.hpp"

#include <array>
#include <optional>

#include "tests/study/joint_planning/joint_scene.hpp"
#include "tests/study/joint_planning/joint_trial.hpp"
#include "tests/study/measurement/distribution.hpp"

namespace sidestep {
namespace {

struct ExplicitSizes {
  std::vector<int> robots{2, 4, 6, 8, 12, 16};
  int trials = kMinForP99;  // number of trials of explicit planners
  int driven_trials = 200;  // the safety search runs only this many of them, the first ones
  double budget_s = 1;
};
ExplicitSizes quick_explicit_sizes() { return {{2, 4}, 3, 2, 0.5}; }

constexpr std::array kMethods{JointMethod::kComposite, JointMethod::kPrioritised, JointMethod::kSafetySearch};

/// The trials of one method with one number of robots.
struct Trials {
  int count = 0, solved = 0, faults = 0;
  Distribution plan_us, makespan_ratio, cycle_us, cycle_p99_us;

  void add(const JointTrial& trial) {
    ++count;
    solved += trial.solved;
    faults += !trial.fault.empty();
    plan_us.add(trial.plan_us);
    if (trial.solved) makespan_ratio.add(trial.makespan_ratio);
    cycle_us.add(trial.cycle_us);
    cycle_p99_us.add(trial.cycle_p99_us);
  }
  double solved_percent() const { return 100.0 * solved / count; }
};

std::string number_or_none(bool is_known, double number, int digits) {
  return is_known ? fmt::format("{:.{}f}", number, digits) : "-";
}

std::vector<std::string> trials_row(JointMethod method, int robots, const Trials& trials) {
  const bool has_cycles = method == JointMethod::kSafetySearch, is_solved = trials.solved > 0;
  return {name_of(method),
          fmt::format("{}", robots),
          fmt::format("{}", trials.count),
          fmt::format("{:.1f}", trials.solved_percent()),
          fmt::format("{}", trials.faults),
          fmt::format("{:.0f}", trials.plan_us.median()),
          number_or_none(!has_cycles, trials.plan_us.quantile(0.99), 0),
          number_or_none(is_solved, trials.makespan_ratio.median(), 2),
          number_or_none(is_solved, trials.makespan_ratio.quantile(0.9), 2),
          number_or_none(has_cycles, trials.cycle_us.median(), 1),
          number_or_none(has_cycles, trials.cycle_p99_us.median(), 1)};
}

StudyTable empty_table(JointScene scene) {
  StudyTable table;
  table.name = name_of(scene);
  table.columns = {"method", "robots",   "scenes",       "solved_percent", "faults",      "plan_us",
                   "p99_us", "makespan", "makespan_p90", "cycle_us",       "cycle_p99_us"};
  Plot solved{table.name + ": solved", "robots", "scenes [%]"},
      time{"planning, all robots", "robots", "time [ms]"},
      makespan{"makespan", "robots", "over the longest straight line"};
  time.has_log_y = true;
  table.plots = {solved, time, makespan};
  for (Plot& plot : table.plots)
    for (const JointMethod method : kMethods) plot.lines.push_back({name_of(method), {}});
  return table;
}

/// The error bars exclude extremes, because the safety search is timed by the wall clock and some times
/// include other processes.
PlotPoint point_of(double x, const Distribution& values, double scale) {
  return {x, scale * values.median(), scale * values.quantile(0.1), scale * values.quantile(0.9)};
}

void add_to_plots(StudyTable& table, std::size_t method, int robots, const Trials& trials) {
  const double x = robots;
  table.plots[0].lines[method].points.push_back(plot_point(x, trials.solved_percent()));
  table.plots[1].lines[method].points.push_back(point_of(x, trials.plan_us, 1e-3));
  if (trials.solved > 0) table.plots[2].lines[method].points.push_back(point_of(x, trials.makespan_ratio, 1));
}

}  // namespace

int study_joint_planning(const StudyOptions& options) {
  require_study_output(options);
  const ExplicitSizes sizes = options.is_quick ? quick_explicit_sizes() : ExplicitSizes{};
  int faults = 0;
  for (const JointScene scene : {JointScene::kSwap, JointScene::kCircle}) {
    StudyTable table = empty_table(scene);
    StudyProgress progress(table.name);
    std::size_t done = 0;
    const std::size_t of = sizes.robots.size() * static_cast<std::size_t>(sizes.trials);
    for (const int robots : sizes.robots) {
      std::array<Trials, kMethods.size()> trials;
      for (int trial = 0; trial < sizes.trials; ++trial) {
        const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(trial);
        const Scenario scenario = joint_scene(scene, robots, seed);
        for (std::size_t i = 0; i < kMethods.size(); ++i)
          if (kMethods[i] != JointMethod::kSafetySearch || trial < sizes.driven_trials)
            trials[i].add(run_joint_trial(kMethods[i], scenario, sizes.budget_s, seed));
        progress(++done, of);
      }
      for (std::size_t i = 0; i < kMethods.size(); ++i) {
        table.rows.push_back(trials_row(kMethods[i], robots, trials[i]));
        add_to_plots(table, i, robots, trials[i]);
        faults += trials[i].faults;
      }
    }
    fmt::print("{}", markdown_of(table));
    write_study_table(table, "explicit", options);
  }
  return faults == 0 ? 0 : 1;
}

}  // namespace sidestep
