// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/cache_strategies.hpp"

#include <array>

#include "agents/planning/trees/errt.hpp"
#include "deploy/evaluation/study/planning/contestant.hpp"

namespace sidestep {
namespace {

// With the usual 0.1, nothing would be left to chance at the highest probability.
constexpr double kGoalProbability = 0.05;

struct Strategy {
  const char* name;
  CacheReplacement replacement;
};
constexpr std::array kStrategies{Strategy{"random", CacheReplacement::kRandom},
                                 Strategy{"oldest", CacheReplacement::kOldest},
                                 Strategy{"least recently used", CacheReplacement::kLeastRecentlyUsed},
                                 Strategy{"whole plan", CacheReplacement::kWholePlan}};

std::vector<Contestant> contestants_with(double waypoint_probability, std::uint64_t seed) {
  // Seeds of their own: where all do the same, who comes later is faster by what the processor has learned.
  Rng seeds(seed);
  std::vector<Contestant> contestants;
  for (const Strategy& strategy : kStrategies) {
    const ErrtSettings settings{.goal_probability = kGoalProbability,
                                .waypoint_probability = waypoint_probability,
                                .replacement = strategy.replacement};
    contestants.push_back(contestant<Errt<DiscDomain>>(strategy.name, seeds.bits(), settings));
  }
  return contestants;
}

}  // namespace

StudyTable cache_strategies(const CacheStrategies& settings, std::uint64_t seed,
                            const StudyAdvance& advance) {
  StudyTable table;
  table.name = "strategies";
  table.columns = plan_columns({"waypoint_probability", "strategy"});
  const std::string title = fmt::format("ERRT, {} courses of {} replans", settings.courses, settings.replans);
  for (const char* quantile : {"median", "95th percentile"})
    table.plots.push_back({.title = title,
                           .x_label = "probability to grow towards a way point",
                           .y_label = fmt::format("time of a replan, {} [us]", quantile),
                           .has_log_y = true});
  for (Plot& plot : table.plots)
    for (const Strategy& strategy : kStrategies) plot.lines.push_back({strategy.name, {}});

  const std::size_t runs = settings.waypoint_probabilities.size() * settings.courses * settings.replans;
  std::size_t done = 0;
  for (const double probability : settings.waypoint_probabilities) {
    std::array<PlanMeasures, kStrategies.size()> all;
    for (std::size_t course = 0; course < settings.courses; ++course) {
      std::vector<Contestant> contestants = contestants_with(probability, seed + course);
      replan_all(contestants, settings.replans, seed + course, [&] { advance(++done, runs); });
      for (std::size_t i = 0; i < contestants.size(); ++i) all[i].add(contestants[i].measures());
    }
    for (std::size_t i = 0; i < kStrategies.size(); ++i) {
      const PlanMeasures& m = all[i];
      table.rows.push_back(plan_cells(cells(probability, kStrategies[i].name), m));
      table.plots[0].lines[i].points.push_back(plot_point(probability, m.plan_us.median()));
      table.plots[1].lines[i].points.push_back(plot_point(probability, m.plan_us.at(0.95)));
    }
  }
  return table;
}

}  // namespace sidestep
