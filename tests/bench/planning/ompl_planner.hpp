// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/bench/planning/bench_planner.hpp"

namespace sidestep {

/// OMPL's RRT, RRTConnect, KPIECE and BIT*; none when built without OMPL.
const std::vector<std::string>& ompl_planner_names();

/// OMPL's version, origin and compile options, or that they are unknown.
[[nodiscard]] std::string ompl_build();

/// A planner of the Open Motion Planning Library (Sucan, Moll, Kavraki 2012) with this project's exact
/// collision checks and OMPL's own smoothing. Every query constructs a new OMPL planner; the measured time is
/// that of solve() alone, without construction, setup and destruction. Range and goal bias are OMPL's
/// defaults, which the namesakes also use. The world must outlive this object.
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
