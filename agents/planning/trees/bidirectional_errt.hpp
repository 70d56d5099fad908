// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/trees/bridges.hpp"
#include "agents/planning/trees/waypoint_cache.hpp"

namespace sidestep {

struct BidirectionalErrtSettings {
  std::size_t cache_capacity = 50;  ///< 0: no cache
  /// Maximum number of extensions per turn of one tree towards its target; 1: RRT-Connect.
  std::size_t growth_extensions = 100;
  std::size_t connect_extensions = 100;  ///< maximum extensions per turn of the other tree to the new node
  std::size_t bridges = 1;               ///< number of bridges at which planning ends
  /// Whether to try the straight path before the trees grow, and to make the goal their first target.
  /// RRT-Connect does neither.
  bool tries_straight_line = true;
};

/// Bidirectional multi-bridge ERRT (Bruce 2006, section 4.3.4). A tree from the start and a tree from the
/// goal grow alternately: one towards a target, the other towards the node that the first tree reached
/// (RRT-Connect; Kuffner and LaValle 2000). Planning ends once the requested number of bridges join the
/// trees; the plan is the shortest path through both trees. Caches plans for the next query, and reuses its
/// memory.
template <StraightDomain D>
class BidirectionalErrt {
 public:
  using State = typename D::State;

  explicit BidirectionalErrt(const BidirectionalErrtSettings& settings = {})
      : settings_(settings), cache_(settings.cache_capacity, CacheReplacement::kRandom) {}

  /// The result belongs to this planner and is valid until its next plan.
  const Plan<State>& plan(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    plan_and_remember(domain, start, cache_, plan_, rng, settings_.tries_straight_line,
                      [&] { grow(domain, start, budget, rng); });
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
      const bool is_goal_first = settings_.tries_straight_line && plan_.samples == 0;
      grow_towards(domain, turn, is_goal_first ? goal : choose_target(domain, rng));
      ++plan_.samples;
      turn = 1 - turn;
    }
    plan_.nodes = trees_[0].size() + trees_[1].size();
    if (bridges_.size() > 0) {
      plan_.length = bridges_.shortest(trees_[0], trees_[1], plan_.states);
      plan_.reason = PlanReason::kSolved;
    } else {
      write_nearest_to_goal(domain, goal);
    }
  }

  void grow_towards(const D& domain, std::size_t turn, const State& target) {
    SearchTree<D>&mine = trees_[turn], &other = trees_[1 - turn];
    const Node before = static_cast<Node>(mine.size());
    const Node node = extend(domain, mine, mine.nearest(domain, target), target, settings_.growth_extensions);
    if (node < before) return;
    const Node nearest = other.nearest(domain, mine[node]);
    const Node across = extend(domain, other, nearest, mine[node], settings_.connect_extensions);
    if (domain.distance(other[across], mine[node]) > 0) return;
    if (turn == 0) {
      bridges_.add(node, across);
    } else {
      bridges_.add(across, node);
    }
  }

  /// Repeatedly extends the tree from a node towards the target; returns the last node.
  Node extend(const D& domain, SearchTree<D>& tree, Node node, const State& target,
              std::size_t max_extensions) {
    for (std::size_t i = 0; i < max_extensions; ++i) {
      const std::optional<State> reached = domain.extend(tree[node], target);
      if (!reached) return node;
      node = tree.add(domain, *reached, node);
      if (domain.distance(*reached, target) <= 0) return node;
    }
    return node;
  }

  State choose_target(const D& domain, Rng& rng) {
    if (!cache_.is_empty() && rng.chance(kWaypointProbability)) return cache_.sample(rng);
    return domain.sample(rng);
  }

  /// Writes the path to the node of the start tree nearest to the goal.
  void write_nearest_to_goal(const D& domain, const State& goal) {
    const Node best = trees_[0].nearest(domain, goal);
    plan_.states.push_back(trees_[0][0]);
    trees_[0].append_downwards(0, best, plan_.states);
    plan_.length = trees_[0].cost(best);
  }

  static constexpr double kWaypointProbability = 0.4;  // used while the cache is not empty

  BidirectionalErrtSettings settings_;
  WaypointCache<State> cache_;
  SearchTree<D> trees_[2];
  Bridges<D> bridges_;
  Plan<State> plan_;
};

}  // namespace sidestep
