// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "deploy/evaluation/planning/bench/bench_planner.hpp"

namespace sidestep {

/// OMPL's RRT, RRTConnect, KPIECE and BIT*; none when built without OMPL.
const std::vector<std::string>& ompl_planner_names();

/// OMPL's version, where it comes from and how it was compiled, as far as that is known.
[[nodiscard]] std::string ompl_build();

/// A planner of the Open Motion Planning Library (Sucan, Moll, Kavraki 2012) with this project's exact
/// collision checks and that library's own smoothing. It is made anew for each query; the time counts its
/// solve() alone, not its construction, setup and destruction. Ranges and goal biases are those of the
/// namesakes, which are OMPL's defaults. The world has to outlive it.
class OmplPlanner {
 public:
  OmplPlanner(const std::string& name, const BenchmarkWorld& world, std::uint64_t seed);
  ~OmplPlanner();

  TimedPlan plan(const PlanQuery& query, double max_ms);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sidestep
