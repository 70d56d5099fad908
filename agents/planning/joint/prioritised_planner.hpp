// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/joint/joint_plan.hpp"
#include "agents/planning/joint/space_time_domain.hpp"
#include "agents/planning/trees/errt.hpp"

namespace sidestep {

struct PrioritisedSettings {
  SpaceTimeSettings domain{};
  ErrtSettings tree{};
  std::size_t plans_per_robot = 8;       ///< of which the one that arrives first is kept
  std::size_t samples_per_robot = 1500;  ///< for one tree, before another order is tried
  std::size_t max_orders = 1000;         ///< maximum number of orders that are tried
};

/// Plans robots one after another (Erdmann and Lozano-Pérez 1987): each in space × time around the courses of
/// those before it. A robot that finds no path becomes the first, and planning begins anew; if it was
/// first already, the order is shuffled. Fast, but incomplete: those before a robot do not leave it room.
class PrioritisedPlanner {
 public:
  explicit PrioritisedPlanner(const PrioritisedSettings& settings = {}) : settings_(settings) {}

  /// kUnreachable if starts or goals touch each other, an obstacle or the border. Of the budget, the samples
  /// and the time count. Throws std::invalid_argument for problems that check() refuses.
  [[nodiscard]] JointPlan plan(const JointProblem& problem, const Budget& budget, Rng& rng);

 private:
  using Tree = Errt<SpaceTimeDomain>;
  /// Plans in this order; returns the place in it of the first robot without a path, or the number of robots.
  std::size_t plan_in_order(const JointProblem& problem, const std::vector<std::size_t>& order,
                            const Budget& budget, Rng& rng, JointPlan& result);
  /// The path of a robot that arrives first of several; empty if there is none. Counts samples.
  std::vector<SpaceTimeState> path_of(std::size_t robot, const SpaceTimeDomain& domain, const Budget& budget,
                                      Rng& rng, std::size_t& samples);

  PrioritisedSettings settings_;
  std::vector<Tree> trees_;  // by robot: each one remembers its earlier paths
};

}  // namespace sidestep
