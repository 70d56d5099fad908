// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "agents/planning/joint/joint_plan.hpp"

namespace sidestep {

/// The planning domain of all robots together (Bruce 2006, chapter 5). A state contains the positions of all
/// robots, at rest. In a motion, all robots leave together, drive straight with the same speed profile scaled
/// to their distances, and arrive together. So a motion is a straight line in the composite space, and every
/// check is exact. Keeps a reference to the problem, which must outlive it.
class CompositeDomain {
 public:
  using State = std::vector<Vec2>;

  explicit CompositeDomain(const JointProblem& problem) : problem_(&problem) {}

  /// The Euclidean distance in the composite space.
  double distance(const State& a, const State& b) const;
  /// Makes one step, in which robots wait if their motion would touch another robot or an obstacle.
  std::optional<State> extend(const State& from, const State& to) const;
  bool check(const State& from, const State& to) const;
  State sample(Rng& rng) const;
  const State& starts() const { return problem_->starts_m; }
  State goal(const State&) const { return problem_->goals_m; }
  State between(const State& a, const State& b, double fraction) const;

 private:
  bool is_clear_of_obstacles(const Vec2& from, const Vec2& to) const;
  bool are_clear(const State& from, const State& to, std::size_t i, std::size_t j) const;
  Vec2 sample_free(Rng& rng) const;

  const JointProblem* problem_;
};

static_assert(StraightDomain<CompositeDomain>);

}  // namespace sidestep
