// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/plan.hpp"
#include "agents/planning/roadmaps/roadmap.hpp"

namespace sidestep {

struct PrmSettings {
  /// Number of nodes sampled initially, and again while the roadmap does not solve the query.
  std::size_t nodes = 200;
  ConnectionSettings connection = {};
  bool keep_roadmap = true;  ///< whether to keep the roadmap for the next query
  /// Allows the world to differ between queries: a motion is checked again when A* takes it from the queue.
  bool is_dynamic = false;
};

/// Settings for a new roadmap per query, which grows until there is a path.
inline PrmSettings one_shot_prm() { return {.nodes = 40, .keep_roadmap = false}; }
/// Settings for a world with moving obstacles, with radial connection (Dynamic PRM; Bruce 2006, section 4.4).
/// The roadmap keeps blocked motions, to use the space that moving obstacles vacate.
inline PrmSettings dynamic_prm() {
  return {.connection = {.method = Connection::kRadial, .neighbours = 8, .blocked_per_sector = 2},
          .is_dynamic = true};
}

/// The probabilistic roadmap (Kavraki et al. 1996; Bruce 2006, section 4.4): random free states joined by
/// free motions. A query joins its start and goal to the roadmap and takes the shortest path (A*). Reuses its
/// memory between queries.
template <EuclideanDomain D>
class Prm {
 public:
  using State = typename D::State;

  explicit Prm(const PrmSettings& settings = {}) : settings_(settings) {}

  /// The result belongs to this planner and is valid until its next plan. The first query builds the roadmap.
  const Plan<State>& plan(const D& domain, const State& start, const Budget& budget, Rng& rng) {
    begin_plan(domain, start, plan_);
    if (plan_straight(domain, start, plan_)) return plan_;
    if (!settings_.keep_roadmap) clear();
    if (settings_.is_dynamic) ++version_;
    if (base_size_ == 0) sample_nodes(domain, budget, rng);
    while (!query(domain, start) && !budget.is_spent(map_.size() + settings_.nodes, plan_.samples))
      sample_nodes(domain, budget, rng);
    // A full roadmap that does not solve the query is rebuilt for the next query.
    if (!plan_.arrives() && map_.size() + settings_.nodes >= budget.nodes) clear();
    plan_.length = length_of(domain, plan_.states);
    return plan_;
  }

  /// Builds the roadmap ahead of the first query; has no effect if there is a roadmap already.
  void build(const D& domain, const Budget& budget, Rng& rng) {
    plan_.samples = 0;
    if (base_size_ == 0) sample_nodes(domain, budget, rng);
  }

  /// Discards the roadmap, for use with another world or domain.
  void clear() {
    map_.clear();
    base_size_ = 0;
  }

  const Roadmap<D>& roadmap() const { return map_; }

 private:
  using Node = typename Roadmap<D>::Node;
  struct Open {
    double estimate;
    double cost;
    Node node;
    std::uint32_t edge;  // edge by which the node was reached
  };
  static bool has_higher_estimate(const Open& a, const Open& b) { return a.estimate > b.estimate; }

  void sample_nodes(const D& domain, const Budget& budget, Rng& rng) {
    map_.shrink(base_size_);
    const std::size_t wanted = base_size_ + settings_.nodes;
    while (map_.size() < wanted && !budget.is_spent(map_.size(), plan_.samples)) {
      const State state = domain.sample(rng);
      ++plan_.samples;
      if (domain.check(state, state)) map_.add(domain, state, settings_.connection, version_);
    }
    base_size_ = map_.size();
  }

  bool query(const D& domain, const State& start) {
    map_.shrink(base_size_);
    const State goal = domain.goal(start);
    // The world does not change within a query.
    ConnectionSettings connection = settings_.connection;
    connection.blocked_per_sector = 0;
    const Node from = map_.add(domain, start, connection, version_);
    const Node to = map_.add(domain, goal, connection, version_);
    plan_.nodes = map_.size();
    const Node reached = search(domain, from, to);
    write_plan(from, reached);
    if (reached == to) plan_.reason = PlanReason::kSolved;
    return reached == to;
  }

  /// A* search, which checks a motion when it is taken from the queue. Returns the goal, or else the reached
  /// node nearest to it.
  Node search(const D& domain, Node from, Node to) {
    reached_by_.assign(map_.size(), kNone);
    queue_.clear();
    Node nearest = from;
    double nearest_distance = std::numeric_limits<double>::infinity();
    queue_.push_back({domain.distance(map_[from], map_[to]), 0, from, kStart});
    while (!queue_.empty()) {
      std::pop_heap(queue_.begin(), queue_.end(), has_higher_estimate);
      const Open open = queue_.back();
      queue_.pop_back();
      if (reached_by_[open.node] != kNone) continue;
      if (settings_.is_dynamic && open.edge != kStart && !map_.is_free(domain, open.edge, version_)) continue;
      reached_by_[open.node] = open.edge;
      if (open.node == to) return to;
      if (open.estimate - open.cost < nearest_distance) {
        nearest_distance = open.estimate - open.cost;
        nearest = open.node;
      }
      for (const std::uint32_t edge : map_.edges_of(open.node)) {
        const Node next = map_.edges()[edge].other(open.node);
        if (reached_by_[next] != kNone || is_known_blocked(map_.edges()[edge])) continue;
        const double cost = open.cost + map_.edges()[edge].length;
        queue_.push_back({cost + domain.distance(map_[next], map_[to]), cost, next, edge});
        std::push_heap(queue_.begin(), queue_.end(), has_higher_estimate);
      }
    }
    return nearest;
  }

  bool is_known_blocked(const typename Roadmap<D>::Edge& edge) const {
    return !edge.is_free && edge.checked == version_;
  }

  void write_plan(Node from, Node node) {
    plan_.states.clear();
    for (; node != from; node = map_.edges()[reached_by_[node]].other(node))
      plan_.states.push_back(map_[node]);
    plan_.states.push_back(map_[from]);
    std::reverse(plan_.states.begin(), plan_.states.end());
  }

  static constexpr std::uint32_t kNone = 0xffffffff, kStart = 0xfffffffe;

  PrmSettings settings_;
  Roadmap<D> map_;
  std::size_t base_size_ = 0;              // number of nodes without the start and goal of the last query
  std::uint32_t version_ = 1;              // version of the world; changes only if the world does
  std::vector<std::uint32_t> reached_by_;  // indexed by node: the edge by which the search reached it
  std::vector<Open> queue_;
  Plan<State> plan_;
};

}  // namespace sidestep
