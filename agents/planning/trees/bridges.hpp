// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "agents/planning/trees/search_tree.hpp"

namespace sidestep {

/// Pairs of nodes at which a tree from the start and a tree from the goal share a state, and the shortest
/// path over the union of both trees.
template <PlanningDomain D>
class Bridges {
 public:
  using Tree = SearchTree<D>;
  using Node = typename Tree::Node;
  using State = typename D::State;

  void clear() { bridges_.clear(); }
  std::size_t size() const { return bridges_.size(); }
  void add(Node from_start, Node from_goal) { bridges_.push_back({from_start, from_goal}); }

  /// Writes the states of the shortest path from the root of the start tree to the root of the goal tree, and
  /// returns its length. Requires at least one bridge.
  double shortest(const Tree& from_start, const Tree& from_goal, std::vector<State>& states) {
    find_shortest(from_start, from_goal);
    // Follows the labels back to the start from the goal, which is the last end of the goal tree.
    order_.clear();
    for (End end{true, bridges_.size()};; end = label_of(end).previous) {
      order_.push_back(end);
      if (end == start()) break;
    }
    states.clear();
    states.push_back(from_start[0]);
    for (std::size_t i = order_.size() - 1; i > 0; --i) {
      const End from = order_[i], to = order_[i - 1];
      if (from.in_goal_tree != to.in_goal_tree) continue;
      const Tree& tree = to.in_goal_tree ? from_goal : from_start;
      const Node ancestor = tree.common_ancestor(node_of(from), node_of(to));
      append_up_and_down(tree, node_of(from), ancestor, node_of(to), states);
    }
    return label_of({true, bridges_.size()}).cost;
  }

 private:
  struct Bridge {
    Node start_node, goal_node;
  };
  /// The end of a bridge in one of the trees; index bridges_.size() means the tree's root.
  struct End {
    bool in_goal_tree = false;
    std::size_t bridge = 0;
    bool operator==(const End&) const = default;
  };
  struct Label {
    double cost = std::numeric_limits<double>::infinity();
    End previous;
    bool is_done = false;
  };

  End start() const { return {false, bridges_.size()}; }
  Label& label_of(const End& end) { return labels_[end.bridge * 2 + (end.in_goal_tree ? 1 : 0)]; }
  Node node_of(const End& end) const {
    if (end.bridge == bridges_.size()) return 0;
    return end.in_goal_tree ? bridges_[end.bridge].goal_node : bridges_[end.bridge].start_node;
  }

  static double distance_within(const Tree& tree, Node a, Node b) {
    return tree.cost(a) + tree.cost(b) - 2 * tree.cost(tree.common_ancestor(a, b));
  }

  /// Appends the states after `from`, up to `ancestor` and down to `to`.
  static void append_up_and_down(const Tree& tree, Node from, Node ancestor, Node to,
                                 std::vector<State>& states) {
    if (from != ancestor) {
      states.pop_back();
      tree.append_upwards(from, ancestor, states);
      states.push_back(tree[ancestor]);
    }
    tree.append_downwards(ancestor, to, states);
  }

  /// Dijkstra over the ends of the bridges and the roots. Within a tree, all ends are joined.
  void find_shortest(const Tree& from_start, const Tree& from_goal) {
    labels_.assign((bridges_.size() + 1) * 2, {});
    label_of(start()).cost = 0;
    for (;;) {
      End next{true, bridges_.size()};
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        const End end{i % 2 == 1, i / 2};
        if (!label_of(end).is_done && label_of(end).cost < label_of(next).cost) next = end;
      }
      if (next == End{true, bridges_.size()}) return;
      label_of(next).is_done = true;
      if (next.bridge < bridges_.size()) relax(next, {!next.in_goal_tree, next.bridge}, 0);
      const Tree& tree = next.in_goal_tree ? from_goal : from_start;
      for (std::size_t bridge = 0; bridge <= bridges_.size(); ++bridge) {
        const End other{next.in_goal_tree, bridge};
        if (!label_of(other).is_done)
          relax(next, other, distance_within(tree, node_of(next), node_of(other)));
      }
    }
  }

  void relax(const End& from, const End& to, double length) {
    if (label_of(from).cost + length >= label_of(to).cost) return;
    label_of(to).cost = label_of(from).cost + length;
    label_of(to).previous = from;
  }

  std::vector<Bridge> bridges_;
  std::vector<Label> labels_;
  std::vector<End> order_;
};

}  // namespace sidestep
