// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/roadmap_connections.hpp"

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/roadmaps/prm.hpp"
#include "deploy/evaluation/planning/cpu_clock.hpp"
#include "deploy/evaluation/planning/ground.hpp"
#include "deploy/evaluation/study/planning/contestant.hpp"

namespace sidestep {
namespace {

using Roadmaps = Prm<DiscDomain>;

/// A way to connect, and what it was like.
struct Side {
  const char* method;
  std::string parameter;
  ConnectionSettings connection;
  Numbers edges_per_node{}, build_us{};
  std::vector<PlanMeasures> plans{};  // by how far obstacles moved
};

std::vector<Side> sides_of(const RoadmapConnections& settings) {
  std::vector<Side> sides;
  for (const std::size_t sectors : settings.sectors)
    sides.push_back({"sectors", fmt::format("{}", sectors), {Connection::kRadial, sectors}});
  for (const std::size_t neighbours : settings.neighbours)
    sides.push_back({"nearest", fmt::format("{}", neighbours), {Connection::kNearest, neighbours}});
  for (const double radius_m : settings.radii_m)
    sides.push_back(
        {"within", fmt::format("{} m", radius_m), {.method = Connection::kWithin, .radius = radius_m}});
  for (Side& side : sides) side.plans.resize(settings.moved_m.size());
  return sides;
}

/// The world after each obstacle went so far somewhere, and new queries in it.
Ground ground_after(PlanWorld world, double moved_m, std::size_t queries, Rng& rng) {
  for (Shape& shape : world.obstacles)
    shape = moved(shape, rotated({moved_m, 0}, rng.uniform(0, 6.283185307179586)));
  world.queries.clear();
  ask_across(world, queries, rng);
  return Ground(std::move(world));
}

DiscDomain domain_of(const Ground& ground, const PlanQuery& query) {
  return {ground.obstacles, ground.world.field, ground.world.radius_m, query.start_m, query.goal_m};
}

Roadmaps build(const RoadmapConnections& settings, const Ground& ground, std::uint64_t seed, Side& side) {
  Roadmaps roadmap(PrmSettings{.nodes = settings.nodes, .connection = side.connection, .is_dynamic = true});
  Rng rng(seed);
  const DiscDomain domain = domain_of(ground, ground.world.queries.front());
  const double begin_us = cpu_us();
  roadmap.build(domain, {}, rng);
  side.build_us.add(cpu_us() - begin_us);
  const auto count = [](std::size_t size) { return static_cast<double>(size); };
  side.edges_per_node.add(count(roadmap.roadmap().edges().size()) / count(roadmap.roadmap().size()));
  return roadmap;
}

PlanMeasures ask(const Roadmaps& built, const Ground& ground) {
  // A roadmap that would exceed its budget does not grow.
  const Budget budget{.nodes = built.roadmap().size()};
  PlanMeasures measures;
  Roadmaps roadmap = built;
  Rng rng(0);
  for (std::size_t i = 0; i < ground.world.queries.size(); ++i) {
    const DiscDomain domain = domain_of(ground, ground.world.queries[i]);
    roadmap = built;
    const double begin_us = cpu_us();
    const Plan<Vec2>& plan = roadmap.plan(domain, ground.world.queries[i].start_m, budget, rng);
    measures.add(plan, cpu_us() - begin_us, ground.shortest_m[i]);
  }
  return measures;
}

void ask_world(const RoadmapConnections& settings, std::uint64_t seed, std::vector<Side>& sides) {
  Rng rng(seed);
  const PlanWorld world = make_world("circles", settings.queries, seed);
  const Ground as_built(world);
  std::vector<Ground> grounds;
  for (const double moved_m : settings.moved_m)
    grounds.push_back(ground_after(world, moved_m, settings.queries, rng));
  for (Side& side : sides) {
    const Roadmaps roadmap = build(settings, as_built, seed, side);
    for (std::size_t i = 0; i < grounds.size(); ++i) side.plans[i].add(ask(roadmap, grounds[i]));
  }
}

}  // namespace

StudyTable roadmap_connections(const RoadmapConnections& settings, std::uint64_t seed,
                               const StudyAdvance& advance) {
  std::vector<Side> sides = sides_of(settings);
  for (std::size_t i = 0; i < settings.worlds; ++i) {
    ask_world(settings, seed + i, sides);
    advance(i + 1, settings.worlds);
  }

  StudyTable table;
  table.name = "roadmaps";
  table.columns = plan_columns({"connection", "parameter", "edges_per_node", "build_us", "moved_m"});
  const std::string nodes = fmt::format("{} nodes", settings.nodes);
  table.plots.push_back(
      {.title = nodes, .x_label = "edges per node", .y_label = "time of a query, median [us]"});
  for (const double moved_m : settings.moved_m)
    table.plots.push_back(
        {.title = moved_m == 0 ? nodes : fmt::format("{}, obstacles moved by {} m", nodes, moved_m),
         .x_label = "edges per node",
         .y_label = "queries solved [%]"});
  std::string method;
  for (const Side& side : sides) {
    if (method != side.method)
      for (Plot& plot : table.plots) plot.lines.push_back({side.method, {}});
    method = side.method;
    const double x = side.edges_per_node.median();
    table.plots[0].lines.back().points.push_back(plot_point(x, side.plans[0].plan_us.median()));
    for (std::size_t i = 0; i < settings.moved_m.size(); ++i) {
      const PlanMeasures& m = side.plans[i];
      table.plots[1 + i].lines.back().points.push_back(plot_point(x, m.solved_percent()));
      table.rows.push_back(
          plan_cells(cells(side.method, side.parameter, fmt::format("{:.2f}", x),
                           fmt::format("{:.0f}", side.build_us.median()), settings.moved_m[i]),
                     m));
    }
  }
  return table;
}

}  // namespace sidestep
