// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// Plans also where the goal touches an obstacle: to the nearest free place that the planner can reach. That
/// the start may touch obstacles is the domain's business. `planner` is any with plan(domain, start, budget,
/// rng); each place that is tried has the whole budget.
template <typename Planner>
const Plan<Vec2>& plan_robustly(Planner& planner, const DiscDomain& domain, const Vec2& start,
                                const Budget& budget, Rng& rng) {
  const Plan<Vec2>* plan = &planner.plan(domain, start, budget, rng);
  if (plan->arrives() || !domain.goal_is_blocked()) return *plan;
  // What sees a place that cannot be reached cannot be reached either.
  std::vector<Vec2> tried{domain.goal(start)};
  for (const Vec2& place : domain.places_near_goal()) {
    const auto sees = [&](const Vec2& other) { return domain.check(place, other); };
    if (std::any_of(tried.begin(), tried.end(), sees)) continue;
    const Plan<Vec2>& next = planner.plan(domain.with_goal_at(place), start, budget, rng);
    if (next.arrives()) return next;
    tried.push_back(place);
  }
  return planner.plan(domain, start, budget, rng);
}

}  // namespace sidestep
