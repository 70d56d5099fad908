// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/bridges_and_extensions.hpp"

#include "agents/planning/trees/bidirectional_errt.hpp"
#include "deploy/evaluation/planning/ground.hpp"
#include "deploy/evaluation/study/planning/contestant.hpp"

namespace sidestep {
namespace {

std::vector<Contestant> contestants_of(const BridgesAndExtensions& settings, std::uint64_t seed) {
  Rng seeds(seed);
  std::vector<Contestant> contestants;
  for (const std::size_t extensions : settings.extensions) {
    for (const std::size_t bridges : settings.bridges) {
      const BidirectionalErrtSettings trees{
          .cache_capacity = 0, .extensions = extensions, .bridges = bridges};
      contestants.push_back(contestant<BidirectionalErrt<DiscDomain>>("", seeds.bits(), trees));
    }
  }
  return contestants;
}

}  // namespace

StudyTable bridges_and_extensions(const BridgesAndExtensions& settings, std::uint64_t seed,
                                  const StudyAdvance& advance) {
  std::vector<Contestant> contestants = contestants_of(settings, seed);
  for (std::size_t i = 0; i < settings.worlds; ++i) {
    const Ground ground(make_world("circles", settings.queries, seed + i));
    for (std::size_t query = 0; query < settings.queries; ++query) {
      const auto& [start_m, goal_m] = ground.world.queries[query];
      const DiscDomain domain(ground.obstacles, ground.world.field, ground.world.radius_m, start_m, goal_m,
                              {.step_m = settings.step_m});
      ask_all(contestants, query, domain, start_m, {}, ground.shortest_m[query]);
    }
    advance(i + 1, settings.worlds);
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
                  .least_y = 1},
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
      const PlanMeasures& m = contestants[i++].measures();
      table.rows.push_back(plan_cells(cells(extensions, bridges), m));
      const auto x = static_cast<double>(bridges);
      table.plots[0].lines.back().points.push_back(plot_point(x, m.length.median()));
      table.plots[1].lines.back().points.push_back(plot_point(x, m.plan_us.median()));
    }
  }
  return table;
}

}  // namespace sidestep
