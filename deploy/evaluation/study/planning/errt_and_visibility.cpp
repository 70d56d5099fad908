// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/errt_and_visibility.hpp"

#include "agents/planning/smoothing/leader_follower.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/evaluation/planning/cpu_clock.hpp"
#include "deploy/evaluation/planning/worlds.hpp"
#include "deploy/evaluation/study/planning/contestant.hpp"

namespace sidestep {
namespace {

using OneTree = Errt<DiscDomain>;
using TwoTrees = BidirectionalErrt<DiscDomain>;

/// A planner, and the smoothing of what it finds.
template <typename Planner>
class Smoothed {
 public:
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng) {
    plan_ = planner_.plan(domain, start, budget, rng);
    smoother_.smooth(domain, plan_);
    return plan_;
  }

 private:
  Planner planner_;
  LeaderFollower<DiscDomain> smoother_;
  Plan<Vec2> plan_;
};

/// Who is asked in one world. Caches begin empty.
std::vector<Contestant> contestants(std::uint64_t seed) {
  return {contestant<LazyVisibility>("lazy graph", seed), contestant<OneTree>("one tree", seed),
          contestant<TwoTrees>("two trees", seed), contestant<Smoothed<OneTree>>("one tree smoothed", seed),
          contestant<Smoothed<TwoTrees>>("two trees smoothed", seed)};
}

/// What all planners were like in worlds of one size, in the order of the table.
struct Outcome {
  std::string planner;
  PlanMeasures measures;
};

void ask_world(const PlanWorld& world, std::uint64_t seed, std::vector<Outcome>& outcomes) {
  const ObstacleWorld obstacles(world.obstacles);
  const double begin_us = cpu_us();
  TangentGraph graph(obstacles, world.field, world.radius_m);
  const double build_us = cpu_us() - begin_us;
  std::vector<Contestant> asked = contestants(seed);
  for (std::size_t query = 0; query < world.queries.size(); ++query) {
    const auto& [start_m, goal_m] = world.queries[query];
    const double query_us = cpu_us();
    const Plan<Vec2>& plan = graph.plan(start_m, goal_m);
    const double plan_us = cpu_us() - query_us;
    outcomes[0].measures.add(plan, build_us + plan_us, graph.shortest_m());
    outcomes[1].measures.add(plan, plan_us, graph.shortest_m());
    const DiscDomain domain(obstacles, world.field, world.radius_m, start_m, goal_m);
    ask_all(asked, query, domain, start_m, {}, graph.shortest_m());
  }
  for (std::size_t i = 0; i < asked.size(); ++i) outcomes[2 + i].measures.add(asked[i].measures());
}

}  // namespace

StudyTable errt_and_visibility(const ErrtAndVisibility& settings, std::uint64_t seed,
                               const StudyAdvance& advance) {
  std::vector<std::string> planners{"graph built anew", "graph kept"};
  for (const Contestant& contestant : contestants(seed)) planners.push_back(contestant.name());

  StudyTable table;
  table.name = "visibility";
  table.columns = plan_columns({"obstacles", "planner"});
  const std::string title = fmt::format("{} queries at each size", settings.worlds * settings.queries);
  table.plots = {{.title = title,
                  .x_label = "obstacles",
                  .y_label = "time of a plan, median [us]",
                  .has_log_x = true,
                  .has_log_y = true},
                 {.title = title,
                  .x_label = "obstacles",
                  .y_label = "length over the shortest, median",
                  .has_log_x = true,
                  .least_y = 0.95}};
  for (Plot& plot : table.plots)
    for (const std::string& planner : planners) plot.lines.push_back({planner, {}});

  std::size_t done = 0;
  for (const std::size_t obstacles : settings.obstacles) {
    std::vector<Outcome> outcomes;
    for (const std::string& planner : planners) outcomes.push_back({planner, {}});
    for (std::size_t i = 0; i < settings.worlds; ++i) {
      ask_world(make_circles(obstacles, settings.queries, seed + i), seed + i, outcomes);
      advance(++done, settings.obstacles.size() * settings.worlds);
    }
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const auto& [planner, m] = outcomes[i];
      table.rows.push_back(plan_cells(cells(obstacles, planner), m));
      const auto x = static_cast<double>(obstacles);
      table.plots[0].lines[i].points.push_back(plot_point(x, m.plan_us.median()));
      table.plots[1].lines[i].points.push_back(plot_point(x, m.length.median()));
    }
  }
  return table;
}

}  // namespace sidestep
