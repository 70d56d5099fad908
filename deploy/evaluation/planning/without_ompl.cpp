// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "deploy/evaluation/planning/ompl_planner.hpp"

namespace sidestep {

struct OmplPlanner::Parts {};

const std::vector<std::string>& ompl_planner_names() {
  static const std::vector<std::string> none;
  return none;
}
bool is_ompl_planner(const std::string&) { return false; }

OmplPlanner::OmplPlanner(const std::string& name, const PlanWorld&, const ObstacleWorld&, std::uint64_t) {
  throw std::invalid_argument("built without OMPL, which has the planner " + name);
}
OmplPlanner::~OmplPlanner() = default;
BenchedPlan OmplPlanner::plan(const PlanQuery&, double) { return {}; }

}  // namespace sidestep
