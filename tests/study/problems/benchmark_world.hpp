// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/obstacle_world.hpp"
#include "deploy/trial/planning/worlds.hpp"

namespace sidestep {

/// A world with its collision structure and the lengths of its queries' shortest paths.
struct BenchmarkWorld {
  explicit BenchmarkWorld(PlanWorld made);

  PlanWorld world;
  ObstacleWorld obstacles;
  std::vector<double> shortest_m;  ///< indexed by query; from the full visibility graph; infinite: no path
};

}  // namespace sidestep
