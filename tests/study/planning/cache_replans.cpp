// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/cache_replans.hpp"

#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "tests/study/planning/measured_planner.hpp"
#include "tests/study/problems/replan_course.hpp"

namespace sidestep {
namespace {

/// The cumulative distribution, in percent.
PlotLine cumulative(const std::string& title, const Distribution& values, int max_percent) {
  PlotLine line{title, {}};
  for (int percent = 0; percent <= max_percent; percent += 2)
    line.points.push_back(plot_point(values.quantile(percent / 100.0), percent));
  return line;
}

}  // namespace

StudyTable cache_replans(const CacheReplans& settings, std::uint64_t seed, const ProgressCallback& progress) {
  using Errt = Errt<DiscDomain>;
  using Trees = BidirectionalErrt<DiscDomain>;
  std::vector<MeasuredPlanner> planners{
      measured_planner<Errt>("one tree", seed, ErrtSettings{.cache_capacity = 0}),
      measured_planner<Errt>("one tree with cache", seed),
      measured_planner<Trees>("two trees", seed, BidirectionalErrtSettings{.cache_capacity = 0}),
      measured_planner<Trees>("two trees with cache", seed)};
  std::size_t done = 0;
  replan_all(planners, settings.replans, seed, [&] { progress(++done, settings.replans); });

  StudyTable table;
  table.name = "cache";
  table.columns = plan_columns({"planner"});
  table.plots = {{.title = fmt::format("{} replans among 64 moving circles", settings.replans),
                  .x_label = "time of a replan [us]",
                  .y_label = "replans within this time [%]",
                  .has_log_x = true},
                 {.title = "Their paths",
                  .x_label = "length over the shortest",
                  .y_label = "paths within this length [%]"}};
  for (const MeasuredPlanner& planner : planners) {
    const PlanStatistics& s = planner.statistics();
    table.rows.push_back(plan_cells({planner.name()}, s));
    table.plots[0].lines.push_back(cumulative(planner.name(), s.plan_us, 98));
    table.plots[1].lines.push_back(cumulative(planner.name(), s.length, 94));
  }
  return table;
}

}  // namespace sidestep
