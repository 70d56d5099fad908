// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// Plans to the goal or, if the goal touches an obstacle, to the nearest free position that the planner can
/// reach. The domain handles a start that touches obstacles. `planner` is any planner with plan(domain,
/// start, budget, rng). The goal itself gets the whole budget. All alternative positions together get the
/// same number of samples again, because a planner that samples at random would spend all of them on each
/// unreachable position.
template <typename Planner>
const Plan<Vec2>& plan_with_fallback_goal(Planner& planner, const DiscDomain& domain, const Vec2& start,
                                          const Budget& budget, Rng& rng) {
  const Plan<Vec2>* plan = &planner.plan(domain, start, budget, rng);
  if (plan->arrives() || !domain.goal_is_blocked()) return *plan;
  // Positions connected to an unreachable position by a straight motion are also unreachable.
  std::vector<Vec2> tried{domain.goal(start)};
  Budget rest = budget;
  for (const Vec2& position : domain.free_positions_near_goal()) {
    const auto is_connected = [&](const Vec2& other) { return domain.check(position, other); };
    if (std::any_of(tried.begin(), tried.end(), is_connected)) continue;
    const Plan<Vec2>& next = planner.plan(domain.with_goal_at(position), start, rest, rng);
    if (next.arrives()) return next;
    tried.push_back(position);
    if (next.samples >= rest.samples) break;
    rest.samples -= next.samples;
  }
  return planner.plan(domain, start, budget, rng);
}

}  // namespace sidestep
