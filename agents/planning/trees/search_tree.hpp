// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "agents/planning/trees/kd_tree.hpp"

namespace sidestep {

/// The states that a planner has reached from a root, each with its parent and its distance along the tree.
template <PlanningDomain D>
class SearchTree {
 public:
  using State = typename D::State;
  using Node = std::uint32_t;

  /// Starts a new tree, keeping the allocated memory.
  void start(const D& domain, const State& root) {
    states_.clear();
    parents_.clear();
    costs_.clear();
    if constexpr (EuclideanDomain<D>) neighbours_.clear();
    append(domain, root, 0, 0);
  }

  Node add(const D& domain, const State& state, Node parent) {
    return append(domain, state, parent, costs_[parent] + domain.distance(states_[parent], state));
  }

  Node nearest(const D& domain, const State& state) const {
    if constexpr (EuclideanDomain<D>) {
      return neighbours_.nearest(domain.coordinates(state));
    } else {
      Node best = 0;
      double best_distance = domain.distance(states_[0], state);
      for (Node node = 1; node < states_.size(); ++node) {
        const double distance = domain.distance(states_[node], state);
        if (distance >= best_distance) continue;
        best_distance = distance;
        best = node;
      }
      return best;
    }
  }

  std::size_t size() const { return states_.size(); }
  const State& operator[](Node node) const { return states_[node]; }
  /// The root is its own parent.
  Node parent(Node node) const { return parents_[node]; }
  double cost(Node node) const { return costs_[node]; }

  /// The lowest common ancestor.
  Node common_ancestor(Node a, Node b) const {
    // Parents have lower indices than their children.
    while (a != b) (a > b ? a : b) = parents_[std::max(a, b)];
    return a;
  }

  /// Appends the states from the node up to, but not including, an ancestor.
  void append_upwards(Node node, Node ancestor, std::vector<State>& states) const {
    for (; node != ancestor; node = parents_[node]) states.push_back(states_[node]);
  }
  /// Appends the states from the child of an ancestor down to the node.
  void append_downwards(Node ancestor, Node node, std::vector<State>& states) const {
    const auto first = static_cast<std::ptrdiff_t>(states.size());
    append_upwards(node, ancestor, states);
    std::reverse(states.begin() + first, states.end());
  }

 private:
  Node append(const D& domain, const State& state, Node parent, double cost) {
    states_.push_back(state);
    parents_.push_back(parent);
    costs_.push_back(cost);
    if constexpr (EuclideanDomain<D>) neighbours_.add(domain.coordinates(state));
    return static_cast<Node>(states_.size() - 1);
  }

  template <typename Domain, bool kHasCoordinates>
  struct NeighboursOf {
    struct type {};
  };
  template <typename Domain>
  struct NeighboursOf<Domain, true> {
    using type = KdTree<Domain::kDimensions>;
  };

  std::vector<State> states_;
  std::vector<Node> parents_;
  std::vector<double> costs_;
  typename NeighboursOf<D, EuclideanDomain<D>>::type neighbours_;
};

}  // namespace sidestep
