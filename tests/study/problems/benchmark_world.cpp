// SPDX-License-Identifier: Apache-2.0
#include "tests/study/problems/benchmark_world.hpp"

#include "agents/planning/visibility/tangent_graph.hpp"

namespace sidestep {

BenchmarkWorld::BenchmarkWorld(PlanWorld made) : world(std::move(made)), obstacles(world.obstacles) {
  TangentGraph graph(obstacles, world.field, world.radius_m);
  for (const PlanQuery& query : world.queries) {
    graph.plan(query.start_m, query.goal_m);
    shortest_m.push_back(graph.shortest_m());
  }
}

}  // namespace sidestep
