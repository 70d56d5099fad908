// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "agents/planning/trees/search_tree.hpp"

namespace sidestep {

/// Where a tree from the start and one from the goal have come to the same state, and the shortest way over
/// the union of both.
template <PlanningDomain D>
class Bridges {
 public:
  using Tree = SearchTree<D>;
  using Node = typename Tree::Node;
  using State = typename D::State;

  void clear() { bridges_.clear(); }
  std::size_t size() const { return bridges_.size(); }
  void add(Node from_start, Node from_goal) { bridges_.push_back({from_start, from_goal}); }

  /// Writes the states of the shortest way from the first tree's root to the second's, and returns its
  /// length. There is at least one bridge.
  double shortest(const Tree& from_start, const Tree& from_goal, std::vector<State>& states) {
    measure(from_start, from_goal);
    // The goal is the last end of the second tree; from it back to the start, an end of the first.
    order_.clear();
    for (End end{true, bridges_.size()};; end = at(end).before) {
      order_.push_back(end);
      if (end == start()) break;
    }
    states.clear();
    states.push_back(from_start[0]);
    for (std::size_t i = order_.size() - 1; i > 0; --i) {
      const End from = order_[i], to = order_[i - 1];
      if (from.in_second != to.in_second) continue;
      const Tree& tree = to.in_second ? from_goal : from_start;
      const Node top = tree.common_ancestor(node_of(from), node_of(to));
      append_up_and_down(tree, node_of(from), top, node_of(to), states);
    }
    return at({true, bridges_.size()}).cost;
  }

 private:
  struct Bridge {
    Node first, second;
  };
  /// A bridge's end in one of the trees, or that tree's root.
  struct End {
    bool in_second = false;
    std::size_t bridge = 0;
    bool operator==(const End&) const = default;
  };
  struct Label {
    double cost = std::numeric_limits<double>::infinity();
    End before;
    bool is_done = false;
  };

  End start() const { return {false, bridges_.size()}; }
  Label& at(const End& end) { return labels_[end.bridge * 2 + (end.in_second ? 1 : 0)]; }
  Node node_of(const End& end) const {
    if (end.bridge == bridges_.size()) return 0;
    return end.in_second ? bridges_[end.bridge].second : bridges_[end.bridge].first;
  }

  static double along(const Tree& tree, Node a, Node b) {
    return tree.cost(a) + tree.cost(b) - 2 * tree.cost(tree.common_ancestor(a, b));
  }

  /// Appends what lies behind `from`, up to `top` and down to `to`.
  static void append_up_and_down(const Tree& tree, Node from, Node top, Node to, std::vector<State>& states) {
    if (from != top) {
      states.pop_back();
      tree.append_upwards(from, top, states);
      states.push_back(tree[top]);
    }
    tree.append_downwards(top, to, states);
  }

  /// Dijkstra over the bridges' ends and the roots; within a tree any two are joined.
  void measure(const Tree& from_start, const Tree& from_goal) {
    labels_.assign((bridges_.size() + 1) * 2, {});
    at(start()).cost = 0;
    for (;;) {
      End next{true, bridges_.size()};
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        const End end{i % 2 == 1, i / 2};
        if (!at(end).is_done && at(end).cost < at(next).cost) next = end;
      }
      if (next == End{true, bridges_.size()}) return;
      at(next).is_done = true;
      if (next.bridge < bridges_.size()) relax(next, {!next.in_second, next.bridge}, 0);
      const Tree& tree = next.in_second ? from_goal : from_start;
      for (std::size_t bridge = 0; bridge <= bridges_.size(); ++bridge) {
        const End other{next.in_second, bridge};
        if (!at(other).is_done) relax(next, other, along(tree, node_of(next), node_of(other)));
      }
    }
  }

  void relax(const End& from, const End& to, double length) {
    if (at(from).cost + length >= at(to).cost) return;
    at(to).cost = at(from).cost + length;
    at(to).before = from;
  }

  std::vector<Bridge> bridges_;
  std::vector<Label> labels_;
  std::vector<End> order_;
};

}  // namespace sidestep
