// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/collision/obstacle_world.hpp"
#include "deploy/evaluation/planning/worlds.hpp"

namespace sidestep {

/// A query that was timed.
struct BenchedPlan {
  bool solved = false;
  double plan_us = 0, smooth_us = 0;
  std::vector<Vec2> raw, smooth;
};

/// OMPL's RRTConnect, RRT, KPIECE and BIT*; none when built without OMPL.
const std::vector<std::string>& ompl_planner_names();
bool is_ompl_planner(const std::string& name);

/// A planner of the Open Motion Planning Library (Sucan, Moll, Kavraki 2012) with this project's exact
/// checker of motions, and that library's own smoothing. The world and the obstacles have to stay.
class OmplPlanner {
 public:
  OmplPlanner(const std::string& name, const PlanWorld& world, const ObstacleWorld& obstacles,
              std::uint64_t seed);
  ~OmplPlanner();

  BenchedPlan plan(const PlanQuery& query, double milliseconds);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sidestep
