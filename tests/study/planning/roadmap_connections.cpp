// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/roadmap_connections.hpp"

#include <numeric>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/roadmaps/prm.hpp"
#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/planning/measured_planner.hpp"
#include "tests/study/problems/benchmark_world.hpp"

namespace sidestep {
namespace {

using Roadmaps = Prm<DiscDomain>;

/// A connection method with its parameter, and its results.
struct Variant {
  std::string method, parameter;
  ConnectionSettings connection;
  Distribution edges_per_node{}, build_us{};
  std::vector<PlanStatistics> plans{};  // indexed by displacement
};

std::vector<Variant> variants_of(const RoadmapConnections& settings) {
  std::vector<Variant> variants;
  for (const std::size_t blocked : settings.blocked_per_sector)
    for (const std::size_t sectors : settings.sectors)
      variants.push_back(
          {blocked == 0 ? "sectors" : fmt::format("sectors keeping {}", blocked),
           fmt::format("{}", sectors),
           {.method = Connection::kRadial, .neighbours = sectors, .blocked_per_sector = blocked}});
  for (const std::size_t neighbours : settings.neighbours)
    variants.push_back({"nearest", fmt::format("{}", neighbours), {Connection::kNearest, neighbours}});
  for (const double radius_m : settings.radii_m)
    variants.push_back(
        {"within", fmt::format("{} m", radius_m), {.method = Connection::kRadius, .radius = radius_m}});
  for (Variant& variant : variants) variant.plans.resize(settings.displacements_m.size());
  return variants;
}

/// The world in which each obstacle has moved this far in a random direction, with new queries.
BenchmarkWorld world_after(PlanWorld world, double displacement_m, std::size_t queries, Rng& rng) {
  for (Shape& shape : world.obstacles)
    shape = moved(shape, rotated({displacement_m, 0}, rng.uniform(0, 6.283185307179586)));
  world.queries.clear();
  add_queries_across(world, queries, rng);
  return BenchmarkWorld(std::move(world));
}

DiscDomain domain_of(const BenchmarkWorld& world, const PlanQuery& query) {
  return {world.obstacles, world.world.field, world.world.radius_m, query.start_m, query.goal_m};
}

Roadmaps build(const RoadmapConnections& settings, const BenchmarkWorld& world, std::uint64_t seed,
               Variant& variant) {
  Roadmaps roadmap(
      PrmSettings{.nodes = settings.nodes, .connection = variant.connection, .is_dynamic = true});
  Rng rng(seed);
  const DiscDomain domain = domain_of(world, world.world.queries.front());
  const double begin_us = cpu_us();
  roadmap.build(domain, {}, rng);
  variant.build_us.add(cpu_us() - begin_us);
  const auto count = [](std::size_t size) { return static_cast<double>(size); };
  variant.edges_per_node.add(count(roadmap.roadmap().free_edge_count()) / count(roadmap.roadmap().size()));
  return roadmap;
}

PlanStatistics plan_queries(const Roadmaps& built, const BenchmarkWorld& world) {
  // The budget is the current size of the roadmap, so that it does not grow.
  const Budget budget{.nodes = built.roadmap().size()};
  PlanStatistics statistics;
  Roadmaps roadmap = built;
  Rng rng(0);
  for (std::size_t i = 0; i < world.world.queries.size(); ++i) {
    const DiscDomain domain = domain_of(world, world.world.queries[i]);
    roadmap = built;
    const double begin_us = cpu_us();
    const Plan<Vec2>& plan = roadmap.plan(domain, world.world.queries[i].start_m, budget, rng);
    statistics.add(plan, cpu_us() - begin_us, world.shortest_m[i]);
  }
  return statistics;
}

void measure_world(const RoadmapConnections& settings, std::uint64_t seed, std::vector<Variant>& variants) {
  Rng rng(seed);
  const PlanWorld world = make_world("circles", settings.queries, seed);
  const BenchmarkWorld as_built(world);
  std::vector<BenchmarkWorld> moved_worlds;
  for (const double displacement_m : settings.displacements_m)
    moved_worlds.push_back(world_after(world, displacement_m, settings.queries, rng));
  std::vector<std::size_t> order(variants.size());
  std::iota(order.begin(), order.end(), 0u);
  rng.shuffle(order);
  for (const std::size_t k : order) {
    const Roadmaps roadmap = build(settings, as_built, seed, variants[k]);
    for (std::size_t i = 0; i < moved_worlds.size(); ++i)
      variants[k].plans[i].add(plan_queries(roadmap, moved_worlds[i]));
  }
}

}  // namespace

StudyTable roadmap_connections(const RoadmapConnections& settings, std::uint64_t seed,
                               const ProgressCallback& progress) {
  std::vector<Variant> variants = variants_of(settings);
  for (std::size_t i = 0; i < settings.worlds; ++i) {
    measure_world(settings, seed + i, variants);
    progress(i + 1, settings.worlds);
  }

  StudyTable table;
  table.name = "roadmaps";
  table.columns = plan_columns({"connection", "parameter", "edges_per_node", "build_us", "displacement_m"});
  const std::string nodes = fmt::format("{} nodes", settings.nodes);
  table.plots.push_back(
      {.title = nodes, .x_label = "edges per node", .y_label = "time of a query, median [us]"});
  for (const double displacement_m : settings.displacements_m)
    table.plots.push_back({.title = displacement_m == 0
                                        ? nodes
                                        : fmt::format("{}, obstacles moved by {} m", nodes, displacement_m),
                           .x_label = "edges per node",
                           .y_label = "queries solved [%]"});
  std::string method;
  for (const Variant& variant : variants) {
    if (method != variant.method)
      for (Plot& plot : table.plots) plot.lines.push_back({variant.method, {}});
    method = variant.method;
    const double x = variant.edges_per_node.median();
    table.plots[0].lines.back().points.push_back(plot_point(x, variant.plans[0].plan_us.median()));
    for (std::size_t i = 0; i < settings.displacements_m.size(); ++i) {
      const PlanStatistics& s = variant.plans[i];
      table.plots[1 + i].lines.back().points.push_back(plot_point(x, s.solved_percent()));
      table.rows.push_back(
          plan_cells(cells(variant.method, variant.parameter, fmt::format("{:.2f}", x),
                           fmt::format("{:.0f}", variant.build_us.median()), settings.displacements_m[i]),
                     s));
    }
  }
  return table;
}

}  // namespace sidestep
