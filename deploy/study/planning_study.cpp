// SPDX-License-Identifier: Apache-2.0
#include "deploy/study/planning_study.hpp"

#include "deploy/study/planning/bridges_and_extensions.hpp"
#include "deploy/study/planning/cache_replans.hpp"
#include "deploy/study/planning/cache_strategies.hpp"
#include "deploy/study/planning/errt_and_visibility.hpp"
#include "deploy/study/planning/roadmap_connections.hpp"

namespace sidestep {
namespace {

/// How much of everything.
struct Sizes {
  CacheReplans cache;
  CacheStrategies strategies;
  BridgesAndExtensions bridges;
  ErrtAndVisibility visibility;
  RoadmapConnections roadmaps;
};
Sizes quick_sizes() {
  return {
      {200}, {{0, 0.4}, 1, 100}, {{1, 8}, {1, 4}, 2, 5}, {{4, 64}, 2, 5}, {{8}, {8}, {1.5}, {0, 0.5}, 200, 2, 5}};
}

}  // namespace

int study_planning(const StudyOptions& options) {
  require_study_output(options);
  const Sizes sizes = options.is_quick ? quick_sizes() : Sizes{};
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
  return 0;
}

}  // namespace sidestep
