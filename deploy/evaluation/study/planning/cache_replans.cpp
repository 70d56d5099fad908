// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/cache_replans.hpp"

#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "deploy/evaluation/planning/replan_course.hpp"
#include "deploy/evaluation/study/planning/contestant.hpp"

namespace sidestep {
namespace {

/// Which part of the numbers is no more than x.
PlotLine distribution(const std::string& title, const Numbers& numbers, int most_percent) {
  PlotLine line{title, {}};
  for (int percent = 0; percent <= most_percent; percent += 2)
    line.points.push_back(plot_point(numbers.at(percent / 100.0), percent));
  return line;
}

}  // namespace

StudyTable cache_replans(const CacheReplans& settings, std::uint64_t seed, const StudyAdvance& advance) {
  using Errt = Errt<DiscDomain>;
  using Trees = BidirectionalErrt<DiscDomain>;
  std::vector<Contestant> contestants{
      contestant<Errt>("one tree", seed, ErrtSettings{.cache_capacity = 0}),
      contestant<Errt>("one tree with cache", seed),
      contestant<Trees>("two trees", seed, BidirectionalErrtSettings{.cache_capacity = 0}),
      contestant<Trees>("two trees with cache", seed)};
  std::size_t done = 0;
  replan_all(contestants, settings.replans, seed, [&] { advance(++done, settings.replans); });

  StudyTable table;
  table.name = "cache";
  table.columns = plan_columns({"planner"});
  table.plots = {{.title = fmt::format("{} replans among 64 moving circles", settings.replans),
                  .x_label = "time of a replan [us]",
                  .y_label = "replans that take no more [%]",
                  .has_log_x = true},
                 {.title = "Their ways",
                  .x_label = "length over the shortest",
                  .y_label = "ways that are no longer [%]"}};
  for (const Contestant& c : contestants) {
    const PlanMeasures& m = c.measures();
    table.rows.push_back(plan_cells({c.name()}, m));
    table.plots[0].lines.push_back(distribution(c.name(), m.plan_us, 98));
    table.plots[1].lines.push_back(distribution(c.name(), m.length, 94));
  }
  return table;
}

}  // namespace sidestep
