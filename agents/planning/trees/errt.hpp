// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/trees/search_tree.hpp"
#include "agents/planning/trees/waypoint_cache.hpp"

namespace sidestep {

struct ErrtSettings {
  double goal_probability = 0.1;
  double waypoint_probability = 0.4;  ///< used while the cache is not empty
  std::size_t cache_capacity = 50;    ///< 0: a plain RRT (LaValle 1998)
  CacheReplacement replacement = CacheReplacement::kRandom;
  /// Whether to try a straight line to the goal first; a plain RRT does not.
  bool tries_straight_line = true;
};

/// Extended rapidly-exploring random tree (Bruce and Veloso 2002): a tree from the start that grows towards
/// the goal, towards waypoints of earlier plans, or towards random states. Caches plans for the next query,
/// and reuses its memory.
template <PlanningDomain D>
class Errt {
 public:
  using State = typename D::State;

  explicit Errt(const ErrtSettings& settings = {})
      : settings_(settings), cache_(settings.cache_capacity, settings.replacement) {}

  /// The result belongs to this planner and is valid until its next plan.
  const Plan<State>& plan(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    plan_and_remember(domain, start, cache_, plan_, rng, settings_.tries_straight_line,
                      [&] { grow(domain, start, budget, rng); });
    return plan_;
  }

  const SearchTree<D>& tree() const { return tree_; }
  WaypointCache<State>& cache() { return cache_; }

 private:
  using Node = typename SearchTree<D>::Node;

  void grow(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    tree_.start(domain, start);
    Node best = 0;
    double best_distance = domain.distance(start, domain.goal(start));
    while (best_distance > 0 && !budget.is_spent(tree_.size(), plan_.samples)) {
      const State target = choose_target(domain, best, rng);
      const Node nearest = tree_.nearest(domain, target);
      const std::optional<State> reached = domain.extend(tree_[nearest], target);
      ++plan_.samples;
      if (!reached) continue;
      const Node node = tree_.add(domain, *reached, nearest);
      const double distance = domain.distance(*reached, domain.goal(*reached));
      if (distance >= best_distance) continue;
      best_distance = distance;
      best = node;
    }
    plan_.states.push_back(start);
    tree_.append_downwards(0, best, plan_.states);
    plan_.length = tree_.cost(best);
    plan_.nodes = tree_.size();
    if (best_distance <= 0) plan_.reason = PlanReason::kSolved;
  }

  State choose_target(const D& domain, Node best, Rng& rng) {
    const double chance = rng.uniform();
    if (chance < settings_.goal_probability) return domain.goal(tree_[best]);
    if (chance < settings_.goal_probability + settings_.waypoint_probability && !cache_.is_empty())
      return cache_.sample(rng);
    return domain.sample(rng);
  }

  ErrtSettings settings_;
  WaypointCache<State> cache_;
  SearchTree<D> tree_;
  Plan<State> plan_;
};

}  // namespace sidestep
