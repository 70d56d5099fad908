// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/bridges_and_extensions.hpp"

#include "agents/planning/trees/bidirectional_errt.hpp"
#include "tests/study/planning/measured_planner.hpp"
#include "tests/study/problems/benchmark_world.hpp"

namespace sidestep {
namespace {

std::vector<MeasuredPlanner> planners_of(const BridgesAndExtensions& settings, std::uint64_t seed) {
  Rng seeds(seed);
  std::vector<MeasuredPlanner> planners;
  for (const std::size_t extensions : settings.extensions) {
    for (const std::size_t bridges : settings.bridges) {
      const BidirectionalErrtSettings trees{.cache_capacity = 0,
                                            .growth_extensions = extensions,
                                            .connect_extensions = extensions,
                                            .bridges = bridges};
      planners.emplace_back("", plan_function(std::make_shared<BidirectionalErrt<DiscDomain>>(trees)),
                            seeds.bits(), DiscDomainSettings{.step_m = settings.step_m});
    }
  }
  return planners;
}

}  // namespace

StudyTable bridges_and_extensions(const BridgesAndExtensions& settings, std::uint64_t seed,
                                  const ProgressCallback& progress) {
  std::vector<MeasuredPlanner> planners = planners_of(settings, seed);
  Rng order(seed);
  for (std::size_t i = 0; i < settings.worlds; ++i) {
    const BenchmarkWorld world(make_world("circles", settings.queries, seed + i));
    for (std::size_t query = 0; query < settings.queries; ++query) {
      const PlanQuery& ends = world.world.queries[query];
      plan_all(planners, order, domain_factory(world.obstacles, world.world, ends), ends.start_m, {},
               world.shortest_m[query]);
    }
    progress(i + 1, settings.worlds);
  }

  StudyTable table;
  table.name = "bridges";
  table.columns = plan_columns({"extensions", "bridges"});
  const std::string title = fmt::format("Two trees, steps of {} m, {} queries", settings.step_m,
                                        settings.worlds * settings.queries);
  table.plots = {{.title = title,
                  .x_label = "bridges",
                  .y_label = "length over the shortest, median",
                  .has_log_x = true,
                  .min_y = 1},
                 {.title = title,
                  .x_label = "bridges",
                  .y_label = "time of a plan, median [us]",
                  .has_log_x = true,
                  .has_log_y = true}};
  std::size_t i = 0;
  for (const std::size_t extensions : settings.extensions) {
    for (Plot& plot : table.plots)
      plot.lines.push_back({extensions == 1 ? "one extension" : fmt::format("up to {}", extensions), {}});
    for (const std::size_t bridges : settings.bridges) {
      const PlanStatistics& s = planners[i++].statistics();
      table.rows.push_back(plan_cells(cells(extensions, bridges), s));
      const auto x = static_cast<double>(bridges);
      table.plots[0].lines.back().points.push_back(plot_point(x, s.length.median()));
      table.plots[1].lines.back().points.push_back(plot_point(x, s.plan_us.median()));
    }
  }
  return table;
}

}  // namespace sidestep
