// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/joint/composite_domain.hpp"
#include "agents/planning/joint/joint_plan.hpp"
#include "agents/planning/smoothing/leader_follower.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"

namespace sidestep {

/// Plans all robots together, with two trees in a space of 2n dimensions and subsequent smoothing. All robots
/// are at rest at every state of the path. Probabilistically complete, but the space grows exponentially with
/// the number of robots.
class CompositePlanner {
 public:
  /// Returns kUnreachable if starts or goals touch each other, an obstacle or the border. Throws
  /// std::invalid_argument for problems that check() refuses.
  [[nodiscard]] JointPlan plan(const JointProblem& problem, const Budget& budget, Rng& rng);

 private:
  BidirectionalErrt<CompositeDomain> trees_;
  LeaderFollower<CompositeDomain> smoother_;
};

/// The motions of robots that rest together at every state of a composite path.
[[nodiscard]] std::vector<Course> courses_along(const std::vector<CompositeDomain::State>& path,
                                                const MotionLimits& limits);

}  // namespace sidestep
