// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/obstacle_world.hpp"
#include "deploy/evaluation/planning/worlds.hpp"

namespace sidestep {

/// A world to be asked, and the lengths of the shortest ways in it, by the full visibility graph.
struct Ground {
  explicit Ground(PlanWorld made);

  PlanWorld world;
  ObstacleWorld obstacles;
  std::vector<double> shortest_m;  ///< by query
};

}  // namespace sidestep
