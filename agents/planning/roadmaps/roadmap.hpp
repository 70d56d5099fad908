// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"

namespace sidestep {

/// Which nodes a new node is joined with.
enum class Connection {
  kNearest,  ///< the nearest nodes (Kavraki et al. 1996)
  kRadial,   ///< the nearest visible node in each sector around the new node, by the first two coordinates
  kRadius,   ///< all nodes within a radius
};

struct ConnectionSettings {
  Connection method = Connection::kNearest;
  std::size_t neighbours = 10;  ///< number of nearest nodes, or of sectors for kRadial
  double radius = 1.5;          ///< used with kRadius
  /// Used with kRadial: number of blocked motions kept in each sector, to nodes nearer than the visible node.
  std::size_t blocked_per_sector = 0;
};

/// A graph of states and of motions between them that were free when they were added. Blocked motions can
/// also be kept, because they may become free. New nodes can be removed again, last in, first out.
template <EuclideanDomain D>
class Roadmap {
 public:
  using State = typename D::State;
  using Node = std::uint32_t;

  /// A motion between two nodes. A moving obstacle can block or free it.
  struct Edge {
    Node a = 0, b = 0;
    double length = 0;
    std::uint32_t checked = 0;  ///< version of the world for which is_free is known
    bool is_free = false;

    Node other(Node node) const { return node == a ? b : a; }
  };

  std::size_t size() const { return states_.size(); }
  const State& operator[](Node node) const { return states_[node]; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<std::uint32_t>& edges_of(Node node) const { return incident_edges_[node]; }

  /// Whether an edge is free; checked once per version of the world.
  bool is_free(const D& domain, std::uint32_t edge, std::uint32_t version) {
    Edge& e = edges_[edge];
    if (e.checked != version) {
      e.checked = version;
      e.is_free = domain.check(states_[e.a], states_[e.b]);
    }
    return e.is_free;
  }

  /// Number of edges that were free when last checked.
  std::size_t free_edge_count() const {
    return static_cast<std::size_t>(std::count_if(edges_.begin(), edges_.end(), std::mem_fn(&Edge::is_free)));
  }

  /// Adds a state and joins it to neighbours by free motions, and by blocked motions if the settings keep
  /// them.
  Node add(const D& domain, const State& state, const ConnectionSettings& settings, std::uint32_t version) {
    const Node node = append(state);
    const bool is_radial = settings.method == Connection::kRadial;
    find_candidates(domain, node, settings);
    sectors_.assign(std::max<std::size_t>(1, settings.neighbours), {});
    for (const Neighbour& neighbour : candidates_) {
      Sector& sector = sectors_[is_radial ? sector_of(domain, node, neighbour.node) : 0];
      if (is_radial && sector.is_joined) continue;
      const bool is_free = domain.check(states_[node], states_[neighbour.node]);
      if (is_free)
        sector.is_joined = true;
      else if (!is_radial || sector.blocked++ >= settings.blocked_per_sector)
        continue;
      join(node, neighbour, version, is_free);
    }
    return node;
  }

  void clear() { shrink(0); }

  /// Removes all nodes except the first `nodes`, and their edges.
  void shrink(std::size_t nodes) {
    while (!edges_.empty() && std::max(edges_.back().a, edges_.back().b) >= nodes) {
      incident_edges_[edges_.back().a].pop_back();
      incident_edges_[edges_.back().b].pop_back();
      edges_.pop_back();
    }
    states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(nodes), states_.end());
  }

 private:
  static constexpr std::size_t kCandidatesPerSector = 8;
  struct Sector {
    bool is_joined = false;
    std::size_t blocked = 0;
  };
  struct Neighbour {
    double distance;
    Node node;
    bool operator<(const Neighbour& other) const {
      return distance < other.distance || (distance == other.distance && node < other.node);
    }
  };

  Node append(const State& state) {
    states_.push_back(state);
    if (incident_edges_.size() < states_.size()) incident_edges_.emplace_back();
    return static_cast<Node>(states_.size() - 1);
  }

  void join(Node node, const Neighbour& neighbour, std::uint32_t version, bool is_free) {
    incident_edges_[node].push_back(static_cast<std::uint32_t>(edges_.size()));
    incident_edges_[neighbour.node].push_back(static_cast<std::uint32_t>(edges_.size()));
    edges_.push_back({node, neighbour.node, neighbour.distance, version, is_free});
  }

  /// Writes the nodes that a node may be joined with to candidates_, sorted by distance.
  void find_candidates(const D& domain, Node node, const ConnectionSettings& settings) {
    const bool is_within = settings.method == Connection::kRadius;
    candidates_.clear();
    for (Node other = 0; other < node; ++other) {
      const double distance = domain.distance(states_[node], states_[other]);
      if (!is_within || distance <= settings.radius) candidates_.push_back({distance, other});
    }
    const std::size_t candidate_count =
        settings.neighbours * (settings.method == Connection::kRadial ? kCandidatesPerSector : 1);
    const std::size_t count = is_within ? candidates_.size() : std::min(candidate_count, candidates_.size());
    std::partial_sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(count),
                      candidates_.end());
    candidates_.resize(count);
  }

  std::size_t sector_of(const D& domain, Node from, Node to) const {
    const auto a = domain.coordinates(states_[from]), b = domain.coordinates(states_[to]);
    const double fraction = std::atan2(b[1] - a[1], b[0] - a[0]) / (2 * std::numbers::pi) + 0.5;
    const auto sector = static_cast<std::size_t>(fraction * static_cast<double>(sectors_.size()));
    return std::min(sector, sectors_.size() - 1);
  }

  std::vector<State> states_;
  // Indexed by node; may have unused entries at the end.
  std::vector<std::vector<std::uint32_t>> incident_edges_;
  std::vector<Edge> edges_;
  std::vector<Neighbour> candidates_;
  std::vector<Sector> sectors_;  // sectors around the node that is being added
};

}  // namespace sidestep
