// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// What a planner may spend. Whatever runs out first ends it.
struct Budget {
  std::size_t nodes = 20'000;    ///< states that it keeps
  std::size_t samples = 50'000;  ///< states that it draws or looks at
  Time until = Time::max();      ///< on `clock`; asked for only where there is one
  std::function<Time()> clock = {};

  bool is_spent(std::size_t used_nodes, std::size_t used_samples) const {
    if (used_nodes >= nodes || used_samples >= samples) return true;
    // A clock costs as much as a sample, and most plans are made after a few.
    return clock && used_samples % 16 == 15 && clock() >= until;
  }
};

/// Why a planner returned what it did.
enum class PlanReason {
  kSolved,       ///< a way to the goal
  kImproved,     ///< a way to the goal, shorter than the first one found
  kBudgetSpent,  ///< no way found so far: the states lead as near to the goal as was reached
  kUnreachable,  ///< there is no way, or none on this planner's grid or graph; the states as before
};
const char* name_of(PlanReason reason);

/// A way, valid from state to state, and how it was found.
template <typename State>
struct Plan {
  PlanReason reason = PlanReason::kBudgetSpent;
  /// The start touches an obstacle: the first motion only leads out of it.
  bool start_blocked = false;
  /// The goal touches an obstacle: the way leads to a state near it instead.
  bool goal_blocked = false;
  std::vector<State> states;  ///< from the start; at least that
  double length = 0;          ///< the distances from state to state, summed up
  std::size_t nodes = 0;      ///< that were kept
  std::size_t samples = 0;    ///< that were drawn or looked at

  bool arrives() const { return reason == PlanReason::kSolved || reason == PlanReason::kImproved; }
};

template <PlanningDomain D>
double length_of(const D& domain, const std::vector<typename D::State>& states) {
  double length = 0;
  for (std::size_t i = 1; i < states.size(); ++i) length += domain.distance(states[i - 1], states[i]);
  return length;
}

/// Forgets an earlier plan without giving its memory back, and says what is blocked.
template <PlanningDomain D>
void begin_plan(const D& domain, const typename D::State& start, Plan<typename D::State>& plan) {
  plan.reason = PlanReason::kBudgetSpent;
  plan.start_blocked = !domain.check(start, start);
  plan.goal_blocked = false;
  if constexpr (requires { domain.goal_is_blocked(); }) plan.goal_blocked = domain.goal_is_blocked();
  plan.states.clear();
  plan.length = 0;
  plan.nodes = plan.samples = 0;
}

/// Fills in the straight way to the goal if it is free: most ways on an open floor are.
template <PlanningDomain D>
bool plan_straight(const D& domain, const typename D::State& start, Plan<typename D::State>& plan) {
  const typename D::State goal = domain.goal(start);
  if (!domain.check(start, goal)) return false;
  plan.states.assign({start, goal});
  plan.length = domain.distance(start, goal);
  plan.reason = PlanReason::kSolved;
  plan.nodes = 2;
  return true;
}

}  // namespace sidestep
