// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>

#include "agents/planning/domain/plan.hpp"
#include "agents/planning/smoothing/leader_follower.hpp"

namespace sidestep {

/// Repeats another planner until the budget is spent, smooths each path, and keeps the shortest. The first
/// path takes no longer than with that planner alone; the remaining time is used to improve it.
template <StraightDomain D, typename Planner>
class Anytime {
 public:
  using State = typename D::State;

  explicit Anytime(Planner planner) : planner_(std::move(planner)) {}

  /// The result belongs to this planner and is valid until its next plan.
  const Plan<State>& plan(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    best_ = planner_.plan(domain, start, budget, rng);
    smoother_.smooth(domain, best_);
    const double straight = domain.distance(start, domain.goal(start));
    std::size_t samples = best_.samples;
    Budget rest = budget;
    while (best_.arrives() && best_.length > straight && samples < budget.samples &&
           !(budget.clock && budget.clock() >= budget.until)) {
      rest.samples = budget.samples - samples;
      next_ = planner_.plan(domain, start, rest, rng);
      samples += std::max<std::size_t>(next_.samples, 1);
      smoother_.smooth(domain, next_);
      if (!next_.arrives() || next_.length >= best_.length) continue;
      std::swap(best_, next_);
      best_.reason = PlanReason::kImproved;
    }
    best_.samples = samples;
    return best_;
  }

  Planner& planner() { return planner_; }

 private:
  Planner planner_;
  LeaderFollower<D> smoother_;
  Plan<State> best_, next_;
};

}  // namespace sidestep
