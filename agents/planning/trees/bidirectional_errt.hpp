// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/trees/bridges.hpp"
#include "agents/planning/trees/waypoint_cache.hpp"

namespace sidestep {

struct BidirectionalErrtSettings {
  double waypoint_probability = 0.4;  ///< while there are way points
  std::size_t cache_capacity = 50;    ///< 0: no cache
  CacheReplacement replacement = CacheReplacement::kRandom;
  std::size_t extensions = 100;  ///< towards one target, by each tree
  std::size_t bridges = 1;       ///< it goes on until so many join the trees
};

/// Two trees, from the start and from the goal, that grow in turn: one towards a target, the other towards
/// where the first came to (Kuffner and LaValle 2000), until several bridges join them; the plan is the
/// shortest way over both (Bruce 2006, section 4.5). Remembers plans for the next query, and keeps its
/// memory.
template <StraightDomain D>
class BidirectionalErrt {
 public:
  using State = typename D::State;

  explicit BidirectionalErrt(const BidirectionalErrtSettings& settings = {})
      : settings_(settings), cache_(settings.cache_capacity, settings.replacement) {}

  /// The result is this planner's, until its next plan.
  const Plan<State>& plan(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    plan_and_remember(domain, start, cache_, plan_, rng, [&] { grow(domain, start, budget, rng); });
    return plan_;
  }

  const SearchTree<D>& start_tree() const { return trees_[0]; }
  const SearchTree<D>& goal_tree() const { return trees_[1]; }
  WaypointCache<State>& cache() { return cache_; }

 private:
  using Node = typename SearchTree<D>::Node;

  void grow(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    const State goal = domain.goal(start);
    trees_[0].start(domain, start);
    trees_[1].start(domain, goal);
    bridges_.clear();
    std::size_t turn = 0;
    while (bridges_.size() < settings_.bridges &&
           !budget.is_spent(trees_[0].size() + trees_[1].size(), plan_.samples)) {
      grow_towards(domain, turn, plan_.samples == 0 ? domain.goal(start) : choose(domain, rng));
      ++plan_.samples;
      turn = 1 - turn;
    }
    plan_.nodes = trees_[0].size() + trees_[1].size();
    if (bridges_.size() > 0) {
      plan_.length = bridges_.shortest(trees_[0], trees_[1], plan_.states);
      plan_.reason = PlanReason::kSolved;
    } else {
      approach(domain, goal);
    }
  }

  void grow_towards(const D& domain, std::size_t turn, const State& target) {
    SearchTree<D>&mine = trees_[turn], &other = trees_[1 - turn];
    const Node before = static_cast<Node>(mine.size());
    const Node node = extend(domain, mine, mine.nearest(domain, target), target);
    if (node < before) return;
    const Node near = other.nearest(domain, mine[node]);
    const Node across = extend(domain, other, near, mine[node]);
    if (domain.distance(other[across], mine[node]) > 0) return;
    if (turn == 0) {
      bridges_.add(node, across);
    } else {
      bridges_.add(across, node);
    }
  }

  /// Extends the tree from the node towards the target, again and again; returns the last node.
  Node extend(const D& domain, SearchTree<D>& tree, Node node, const State& target) {
    for (std::size_t i = 0; i < settings_.extensions; ++i) {
      const std::optional<State> reached = domain.extend(tree[node], target);
      if (!reached) return node;
      node = tree.add(domain, *reached, node);
      if (domain.distance(*reached, target) <= 0) return node;
    }
    return node;
  }

  State choose(const D& domain, Rng& rng) {
    if (!cache_.is_empty() && rng.chance(settings_.waypoint_probability)) return cache_.draw(rng);
    return domain.sample(rng);
  }

  /// As near to the goal as the first tree came.
  void approach(const D& domain, const State& goal) {
    const Node best = trees_[0].nearest(domain, goal);
    plan_.states.push_back(trees_[0][0]);
    trees_[0].append_downwards(0, best, plan_.states);
    plan_.length = trees_[0].cost(best);
  }

  BidirectionalErrtSettings settings_;
  WaypointCache<State> cache_;
  SearchTree<D> trees_[2];
  Bridges<D> bridges_;
  Plan<State> plan_;
};

}  // namespace sidestep
