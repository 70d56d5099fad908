// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/cache_strategies.hpp"

#include <array>

#include "agents/planning/trees/errt.hpp"
#include "tests/study/planning/measured_planner.hpp"

namespace sidestep {
namespace {

// Goal probability. With the usual 0.1, the highest waypoint probability would leave no uniform samples.
constexpr double kGoalProbability = 0.05;

struct Strategy {
  const char* name;
  CacheReplacement replacement;
};
constexpr std::array kStrategies{Strategy{"random", CacheReplacement::kRandom},
                                 Strategy{"oldest", CacheReplacement::kOldest},
                                 Strategy{"least recently used", CacheReplacement::kLeastRecentlyUsed},
                                 Strategy{"whole plan", CacheReplacement::kWholePlan}};

std::vector<MeasuredPlanner> planners_with(double waypoint_probability, std::uint64_t seed) {
  // Each planner gets its own seed. With a common seed, all planners would take the same branches, and the
  // processor would predict them for all planners but the first.
  Rng seeds(seed);
  std::vector<MeasuredPlanner> planners;
  for (const Strategy& strategy : kStrategies) {
    const ErrtSettings settings{.goal_probability = kGoalProbability,
                                .waypoint_probability = waypoint_probability,
                                .replacement = strategy.replacement};
    planners.push_back(measured_planner<Errt<DiscDomain>>(strategy.name, seeds.bits(), settings));
  }
  return planners;
}

}  // namespace

StudyTable cache_strategies(const CacheStrategies& settings, std::uint64_t seed,
                            const ProgressCallback& progress) {
  StudyTable table;
  table.name = "strategies";
  table.columns = plan_columns({"waypoint_probability", "strategy"});
  const std::string title = fmt::format("ERRT, {} courses of {} replans", settings.courses, settings.replans);
  for (const char* quantile : {"median", "95th percentile"})
    table.plots.push_back({.title = title,
                           .x_label = "probability to grow towards a waypoint",
                           .y_label = fmt::format("time of a replan, {} [us]", quantile),
                           .has_log_y = true});
  for (Plot& plot : table.plots)
    for (const Strategy& strategy : kStrategies) plot.lines.push_back({strategy.name, {}});

  const std::size_t runs = settings.waypoint_probabilities.size() * settings.courses * settings.replans;
  std::size_t done = 0;
  for (const double probability : settings.waypoint_probabilities) {
    std::array<PlanStatistics, kStrategies.size()> all;
    for (std::size_t course = 0; course < settings.courses; ++course) {
      std::vector<MeasuredPlanner> planners = planners_with(probability, seed + course);
      replan_all(planners, settings.replans, seed + course, [&] { progress(++done, runs); });
      for (std::size_t i = 0; i < planners.size(); ++i) all[i].add(planners[i].statistics());
    }
    for (std::size_t i = 0; i < kStrategies.size(); ++i) {
      const PlanStatistics& s = all[i];
      table.rows.push_back(plan_cells(cells(probability, kStrategies[i].name), s));
      table.plots[0].lines[i].points.push_back(plot_point(probability, s.plan_us.median()));
      table.plots[1].lines[i].points.push_back(plot_point(probability, s.plan_us.quantile(0.95)));
    }
  }
  return table;
}

}  // namespace sidestep
