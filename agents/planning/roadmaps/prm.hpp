// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/plan.hpp"
#include "agents/planning/roadmaps/roadmap.hpp"

namespace sidestep {

struct PrmSettings {
  std::size_t nodes = 200;  ///< of the roadmap when it is built, and by which it grows where it does not do
  ConnectionSettings connection = {};
  bool keeps_roadmap = true;  ///< for the next query
  /// The world may be another for each query: motions are checked anew, each when a way over it promises
  /// most.
  bool is_dynamic = false;
};

/// A roadmap of its own for each query, that grows until there is a way.
inline PrmSettings one_shot_prm() { return {.nodes = 40, .keeps_roadmap = false}; }
/// A roadmap in a world whose obstacles move (Bruce 2006, section 4.9).
inline PrmSettings dynamic_prm() {
  return {.connection = {.method = Connection::kRadial, .neighbours = 8}, .is_dynamic = true};
}

/// The probabilistic roadmap (Kavraki et al. 1996): free states drawn at random, joined by free motions; a
/// query joins its start and goal and takes the shortest way (A*). Keeps its memory.
template <EuclideanDomain D>
class Prm {
 public:
  using State = typename D::State;

  explicit Prm(const PrmSettings& settings = {}) : settings_(settings) {}

  /// The result is this planner's, until its next plan. The first query builds the roadmap.
  const Plan<State>& plan(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    begin_plan(domain, start, plan_);
    if (plan_straight(domain, start, plan_)) return plan_;
    if (!settings_.keeps_roadmap) forget();
    if (settings_.is_dynamic) ++version_;
    if (kept_ == 0) sample_nodes(domain, budget, rng);
    while (!query(domain, start) && !budget.is_spent(map_.size() + settings_.nodes, plan_.samples))
      sample_nodes(domain, budget, rng);
    // What is full and does not do any more begins anew.
    if (!plan_.arrives() && map_.size() + settings_.nodes >= budget.nodes) forget();
    plan_.length = length_of(domain, plan_.states);
    return plan_;
  }

  /// Draws the roadmap, if there is none yet, before a query has to.
  void build(const D& domain, const Budget& budget, Rng& rng) {
    plan_.samples = 0;
    if (kept_ == 0) sample_nodes(domain, budget, rng);
  }

  /// The world, or what a query asks for, has become another.
  void forget() {
    map_.clear();
    kept_ = 0;
  }

  const Roadmap<D>& roadmap() const { return map_; }

 private:
  using Node = typename Roadmap<D>::Node;
  struct Open {
    double promise;
    double cost;
    Node node;
    std::uint32_t edge;  // by which it was reached
  };
  static bool promises_less(const Open& a, const Open& b) { return a.promise > b.promise; }

  void sample_nodes(const D& domain, const Budget& budget, Rng& rng) {
    map_.shrink(kept_);
    const std::size_t wanted = kept_ + settings_.nodes;
    while (map_.size() < wanted && !budget.is_spent(map_.size(), plan_.samples)) {
      const State state = domain.sample(rng);
      ++plan_.samples;
      if (domain.check(state, state)) map_.add(domain, state, settings_.connection, version_);
    }
    kept_ = map_.size();
  }

  bool query(const D& domain, const State& start) {
    map_.shrink(kept_);
    const State goal = domain.goal(start);
    const Node from = map_.add(domain, start, settings_.connection, version_);
    const Node to = map_.add(domain, goal, settings_.connection, version_);
    plan_.nodes = map_.size();
    const Node reached = search(domain, from, to);
    write_plan(from, reached);
    if (reached == to) plan_.reason = PlanReason::kSolved;
    return reached == to;
  }

  /// A* that checks a motion when it is taken from the queue. Returns the goal, or the nearest to it reached.
  Node search(const D& domain, Node from, Node to) {
    came_by_.assign(map_.size(), kNone);
    queue_.clear();
    Node nearest = from;
    double nearest_distance = std::numeric_limits<double>::infinity();
    queue_.push_back({domain.distance(map_[from], map_[to]), 0, from, kStart});
    while (!queue_.empty()) {
      std::pop_heap(queue_.begin(), queue_.end(), promises_less);
      const Open open = queue_.back();
      queue_.pop_back();
      if (came_by_[open.node] != kNone) continue;
      if (settings_.is_dynamic && open.edge != kStart && !map_.is_free(domain, open.edge, version_)) continue;
      came_by_[open.node] = open.edge;
      if (open.node == to) return to;
      if (open.promise - open.cost < nearest_distance) {
        nearest_distance = open.promise - open.cost;
        nearest = open.node;
      }
      for (const std::uint32_t edge : map_.edges_of(open.node)) {
        const Node next = map_.edges()[edge].other(open.node);
        if (came_by_[next] != kNone) continue;
        const double cost = open.cost + map_.edges()[edge].length;
        queue_.push_back({cost + domain.distance(map_[next], map_[to]), cost, next, edge});
        std::push_heap(queue_.begin(), queue_.end(), promises_less);
      }
    }
    return nearest;
  }

  void write_plan(Node from, Node node) {
    plan_.states.clear();
    for (; node != from; node = map_.edges()[came_by_[node]].other(node)) plan_.states.push_back(map_[node]);
    plan_.states.push_back(map_[from]);
    std::reverse(plan_.states.begin(), plan_.states.end());
  }

  static constexpr std::uint32_t kNone = 0xffffffff, kStart = 0xfffffffe;

  PrmSettings settings_;
  Roadmap<D> map_;
  std::size_t kept_ = 0;                // nodes that do not belong to the last query
  std::uint32_t version_ = 1;           // of the world
  std::vector<std::uint32_t> came_by_;  // edge, by node
  std::vector<Open> queue_;
  Plan<State> plan_;
};

}  // namespace sidestep
