// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/errt_and_visibility.hpp"

#include "agents/planning/smoothing/leader_follower.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/planning/measured_planner.hpp"
#include "tests/study/problems/benchmark_world.hpp"

namespace sidestep {
namespace {

using OneTree = Errt<DiscDomain>;
using TwoTrees = BidirectionalErrt<DiscDomain>;

/// A planner followed by the smoothing of its path.
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

/// The full graph of a world, built in advance.
class PrebuiltGraph {
 public:
  explicit PrebuiltGraph(const BenchmarkWorld& world)
      : graph_(world.obstacles, world.world.field, world.world.radius_m) {}
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget&, Rng&) {
    return graph_.plan(start, domain.goal(start));
  }

 private:
  TangentGraph graph_;
};

/// Textbook planners: uniform samples, no cache, no attempt at the straight line.
MeasuredPlanner plain_rrt(std::uint64_t seed) {
  const auto planner =
      std::make_shared<OneTree>(ErrtSettings{.cache_capacity = 0, .tries_straight_line = false});
  return {"RRT", plan_function(planner), seed, {.contact_probability = 0}};
}
MeasuredPlanner plain_rrt_connect(std::uint64_t seed) {
  const auto planner = std::make_shared<TwoTrees>(
      BidirectionalErrtSettings{.cache_capacity = 0, .growth_extensions = 1, .tries_straight_line = false});
  return {"RRT-Connect", plan_function(planner), seed, {.contact_probability = 0}};
}

/// The planners of one world, beginning with the kept graph. Caches are empty at first.
std::vector<MeasuredPlanner> planners_of(const BenchmarkWorld& world, std::uint64_t seed) {
  return {{"graph kept", plan_function(std::make_shared<PrebuiltGraph>(world)), seed},
          measured_planner<LazyVisibility>("lazy graph", seed),
          measured_planner<OneTree>("one tree", seed),
          measured_planner<TwoTrees>("two trees", seed),
          measured_planner<Smoothed<OneTree>>("one tree smoothed", seed),
          measured_planner<Smoothed<TwoTrees>>("two trees smoothed", seed),
          plain_rrt(seed),
          plain_rrt_connect(seed)};
}

/// A row of the table for worlds of one size.
struct Row {
  std::string planner;
  PlanStatistics statistics;
};

std::vector<Row> empty_rows() {
  const BenchmarkWorld world(make_circles(1, 0, 1));
  std::vector<Row> rows{{"graph built anew", {}}};
  for (const MeasuredPlanner& planner : planners_of(world, 1)) rows.push_back({planner.name(), {}});
  return rows;
}

void plan_world(const BenchmarkWorld& world, std::uint64_t seed, std::vector<Row>& rows) {
  const double begin_us = cpu_us();
  const PrebuiltGraph built(world);
  const double build_us = cpu_us() - begin_us;
  std::vector<MeasuredPlanner> planners = planners_of(world, seed);
  Rng order(seed);
  for (std::size_t i = 0; i < world.world.queries.size(); ++i) {
    const PlanQuery& query = world.world.queries[i];
    plan_all(planners, order, domain_factory(world.obstacles, world.world, query), query.start_m, {},
             world.shortest_m[i]);
  }
  for (std::size_t i = 0; i < planners.size(); ++i) rows[1 + i].statistics.add(planners[i].statistics());
  PlanStatistics built_anew = planners[0].statistics();
  built_anew.plan_us = built_anew.plan_us.shifted(build_us);
  rows[0].statistics.add(built_anew);
}

}  // namespace

StudyTable errt_and_visibility(const ErrtAndVisibility& settings, std::uint64_t seed,
                               const ProgressCallback& progress) {
  const std::vector<Row> empty = empty_rows();
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
                  .min_y = 0.95}};
  for (Plot& plot : table.plots)
    for (const Row& row : empty) plot.lines.push_back({row.planner, {}});

  std::size_t done = 0;
  for (const std::size_t obstacles : settings.obstacles) {
    std::vector<Row> rows = empty;
    for (std::size_t i = 0; i < settings.worlds; ++i) {
      plan_world(BenchmarkWorld(make_circles(obstacles, settings.queries, seed + i)), seed + i, rows);
      progress(++done, settings.obstacles.size() * settings.worlds);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& [planner, statistics] = rows[i];
      table.rows.push_back(plan_cells(cells(obstacles, planner), statistics));
      const auto x = static_cast<double>(obstacles);
      table.plots[0].lines[i].points.push_back(plot_point(x, statistics.plan_us.median()));
      table.plots[1].lines[i].points.push_back(plot_point(x, statistics.length.median()));
    }
  }
  return table;
}

}  // namespace sidestep
