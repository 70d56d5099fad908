// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Limits of a planner's effort. Planning ends at the first limit reached.
struct Budget {
  std::size_t nodes = 20'000;    ///< maximum number of states that the planner stores
  std::size_t samples = 50'000;  ///< maximum number of states that it samples or expands
  Time until = Time::max();      ///< deadline on `clock`; ignored without a clock
  std::function<Time()> clock = {};

  bool is_spent(std::size_t used_nodes, std::size_t used_samples) const {
    if (used_nodes >= nodes || used_samples >= samples) return true;
    // Reading a clock costs as much as a sample, and most plans take only a few samples.
    return clock && used_samples % 16 == 15 && clock() >= until;
  }
};

/// Outcome of planning.
enum class PlanReason {
  kSolved,       ///< path to the goal
  kImproved,     ///< path to the goal, shorter than the first path found
  kBudgetSpent,  ///< no path found within the budget; the states lead to the state nearest to the goal
  /// There is no path, at least on this planner's grid or graph; states as for kBudgetSpent.
  kUnreachable,
};
[[nodiscard]] const char* name_of(PlanReason reason);

/// A path whose motions from state to state are valid, with information on how it was found.
template <typename State>
struct Plan {
  PlanReason reason = PlanReason::kBudgetSpent;
  /// The start touches an obstacle: the first motion leads out of it.
  bool start_blocked = false;
  /// The goal touches an obstacle: the path leads to a state near it instead.
  bool goal_blocked = false;
  std::vector<State> states;  ///< starts with the start; never empty
  double length = 0;          ///< sum of the distances from state to state
  std::size_t nodes = 0;      ///< number of states stored
  std::size_t samples = 0;    ///< number of states sampled or expanded

  bool arrives() const { return reason == PlanReason::kSolved || reason == PlanReason::kImproved; }
};

template <PlanningDomain D>
double length_of(const D& domain, const std::vector<typename D::State>& states) {
  double length = 0;
  for (std::size_t i = 1; i < states.size(); ++i) length += domain.distance(states[i - 1], states[i]);
  return length;
}

/// Resets a plan, keeping its allocated memory, and sets its blocked flags.
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

/// Fills in the straight path to the goal if it is free, which is common on open floors. Returns whether it
/// is free.
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
