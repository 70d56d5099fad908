// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/planning_study.hpp"

#include "tests/study/planning/bridges_and_extensions.hpp"
#include "tests/study/planning/cache_replans.hpp"
#include "tests/study/planning/cache_strategies.hpp"
#include "tests/study/planning/collision_domains.hpp"
#include "tests/study/planning/collision_structures.hpp"
#include "tests/study/planning/errt_and_visibility.hpp"
#include "tests/study/planning/roadmap_connections.hpp"
#include "tests/study/planning/terrain_structures.hpp"

namespace sidestep {
namespace {

struct PlanningSizes {
  CacheReplans cache;
  CacheStrategies strategies;
  BridgesAndExtensions bridges;
  ErrtAndVisibility visibility;
  RoadmapConnections roadmaps;
  CollisionStructures collision;
  CollisionDomains domains;
  TerrainStructures terrain;
};
PlanningSizes quick_planning_sizes() {
  PlanningSizes sizes;
  sizes.cache = {.replans = 200};
  sizes.strategies = {.waypoint_probabilities = {0, 0.4}, .courses = 1, .replans = 100};
  sizes.bridges = {.extensions = {1, 8}, .bridges = {1, 4}, .worlds = 2, .queries = 5};
  sizes.visibility = {.obstacles = {4, 64}, .worlds = 2, .queries = 5};
  sizes.roadmaps = {.sectors = {8},
                    .blocked_per_sector = {0, 2},
                    .neighbours = {8},
                    .radii_m = {1.5},
                    .worlds = 2,
                    .queries = 5};
  sizes.collision = {.obstacles = {4, 64, 1024}, .queries = 2000, .rounds = 3};
  sizes.domains = {.queries = 100, .repetitions = 10, .rounds = 3};
  sizes.terrain = {.squares = {4, 16}, .queries = 200, .rounds = 3};
  return sizes;
}

}  // namespace

int study_planning(const StudyOptions& options) {
  require_study_output(options);
  const PlanningSizes sizes = options.is_quick ? quick_planning_sizes() : PlanningSizes{};
  const auto run = [&](const std::string& name, const auto& experiment, const auto& settings) {
    const StudyTable table = experiment(settings, options.seed, StudyProgress(name));
    write_study_table(table, "planning", options);
    fmt::print("{}\n", markdown_of(table));
  };
  run("cache", cache_replans, sizes.cache);
  run("strategies", cache_strategies, sizes.strategies);
  run("bridges", bridges_and_extensions, sizes.bridges);
  run("visibility", errt_and_visibility, sizes.visibility);
  run("roadmaps", roadmap_connections, sizes.roadmaps);
  run("collision", collision_structures, sizes.collision);
  run("domains", collision_domains, sizes.domains);
  run("terrain", terrain_structures, sizes.terrain);
  return 0;
}

}  // namespace sidestep
