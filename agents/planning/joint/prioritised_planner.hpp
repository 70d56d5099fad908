// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/joint/joint_plan.hpp"
#include "agents/planning/joint/space_time_domain.hpp"
#include "agents/planning/trees/errt.hpp"

namespace sidestep {

/// Plans robots one after another (Erdmann and Lozano-Pérez 1987): each in space × time around the courses of
/// the robots planned before it. If a robot finds no path, it is moved to the front of the order and planning
/// restarts; if it was already first, the order is shuffled. Fast, but incomplete: robots planned earlier may
/// leave no room for later robots.
class PrioritisedPlanner {
 public:
  /// Returns kUnreachable if starts or goals touch each other, an obstacle or the border. Only the budget's
  /// sample and time limits apply. Throws std::invalid_argument for problems that check() refuses.
  [[nodiscard]] JointPlan plan(const JointProblem& problem, const Budget& budget, Rng& rng);

 private:
  using Tree = Errt<SpaceTimeDomain>;
  /// Plans in this order. Returns the position in the order of the first robot without a path, or the number
  /// of robots if all have paths.
  std::size_t plan_in_order(const JointProblem& problem, const std::vector<std::size_t>& order,
                            const Budget& budget, Rng& rng, JointPlan& result);
  /// Plans several paths for a robot and returns the path that arrives first; empty if there is none. Adds
  /// the number of samples to `samples`.
  std::vector<SpaceTimeState> path_of(std::size_t robot, const SpaceTimeDomain& domain, const Budget& budget,
                                      Rng& rng, std::size_t& samples);

  std::vector<Tree> trees_;  // indexed by robot; each remembers its earlier paths
};

}  // namespace sidestep
