// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "tests/bench/planning/ompl_planner.hpp"

namespace sidestep {

struct OmplPlanner::Parts {};

const std::vector<std::string>& ompl_planner_names() {
  static const std::vector<std::string> none;
  return none;
}

std::string ompl_build() { return "OMPL: not installed at build time; no peers to compare with"; }

OmplPlanner::OmplPlanner(const std::string& name, const BenchmarkWorld&, std::uint64_t) {
  throw std::invalid_argument(name + " needs OMPL, which was not installed at build time");
}
OmplPlanner::~OmplPlanner() = default;
TimedPlan OmplPlanner::plan(const PlanQuery&, double) { return {}; }

}  // namespace sidestep
