// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"

namespace sidestep {

/// Which nodes a roadmap joins a new one with.
enum class Connection {
  kNearest,  ///< those that are nearest (Kavraki et al. 1996)
  kRadial,   ///< in each sector round it, of the first two coordinates, the nearest that it sees
  kWithin,   ///< all within a radius
};

struct ConnectionSettings {
  Connection method = Connection::kNearest;
  std::size_t neighbours = 10;  ///< of a new node, or its sectors
  double radius = 1.5;          ///< in which all are neighbours, for kWithin
};

/// States and motions between them that may be free, in a graph that grows, and loses what it got last.
template <EuclideanDomain D>
class Roadmap {
 public:
  using State = typename D::State;
  using Node = std::uint32_t;

  struct Edge {
    Node a, b;
    double length;
    std::uint32_t checked = 0;  ///< the version of the world in which it was
    bool is_free = false;

    Node other(Node node) const { return node == a ? b : a; }
  };

  std::size_t size() const { return states_.size(); }
  const State& operator[](Node node) const { return states_[node]; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<std::uint32_t>& edges_of(Node node) const { return joins_[node]; }

  /// Checks the edge unless that was done in this version.
  bool is_free(const D& domain, std::uint32_t edge, std::uint32_t version) {
    Edge& e = edges_[edge];
    if (e.checked != version) {
      e.checked = version;
      e.is_free = domain.check(states_[e.a], states_[e.b]);
    }
    return e.is_free;
  }

  /// Adds a state and joins it with its neighbours by free motions.
  Node add(const D& domain, const State& state, const ConnectionSettings& settings, std::uint32_t version) {
    const Node node = grow(state);
    const bool is_radial = settings.method == Connection::kRadial;
    find_neighbours(domain, node, settings);
    sectors_.assign(settings.neighbours, false);
    for (const Near& near : nearest_) {
      const std::size_t sector = is_radial ? sector_of(domain, node, near.node) : 0;
      if (is_radial && sectors_[sector]) continue;
      if (!domain.check(states_[node], states_[near.node])) continue;
      if (is_radial) sectors_[sector] = true;
      join(node, near, version);
    }
    return node;
  }

  void clear() { shrink(0); }

  /// Takes the last nodes, and what joins them, away.
  void shrink(std::size_t nodes) {
    while (!edges_.empty() && std::max(edges_.back().a, edges_.back().b) >= nodes) {
      joins_[edges_.back().a].pop_back();
      joins_[edges_.back().b].pop_back();
      edges_.pop_back();
    }
    states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(nodes), states_.end());
  }

 private:
  static constexpr std::size_t kLooks = 8;  // neighbours looked at for each sector
  struct Near {
    double distance;
    Node node;
    bool operator<(const Near& other) const {
      return distance < other.distance || (distance == other.distance && node < other.node);
    }
  };

  Node grow(const State& state) {
    states_.push_back(state);
    if (joins_.size() < states_.size()) joins_.emplace_back();
    return static_cast<Node>(states_.size() - 1);
  }

  void join(Node node, const Near& near, std::uint32_t version) {
    joins_[node].push_back(static_cast<std::uint32_t>(edges_.size()));
    joins_[near.node].push_back(static_cast<std::uint32_t>(edges_.size()));
    edges_.push_back({node, near.node, near.distance, version, true});
  }

  /// Those that the node may be joined with, the nearest first.
  void find_neighbours(const D& domain, Node node, const ConnectionSettings& settings) {
    const bool is_within = settings.method == Connection::kWithin;
    nearest_.clear();
    for (Node other = 0; other < node; ++other) {
      const double distance = domain.distance(states_[node], states_[other]);
      if (!is_within || distance <= settings.radius) nearest_.push_back({distance, other});
    }
    const std::size_t looks = settings.neighbours * (settings.method == Connection::kRadial ? kLooks : 1);
    const std::size_t kept = is_within ? nearest_.size() : std::min(looks, nearest_.size());
    std::partial_sort(nearest_.begin(), nearest_.begin() + static_cast<std::ptrdiff_t>(kept), nearest_.end());
    nearest_.resize(kept);
  }

  std::size_t sector_of(const D& domain, Node from, Node to) const {
    constexpr double kFull = 6.283185307179586;
    const auto a = domain.coordinates(states_[from]), b = domain.coordinates(states_[to]);
    const double part = std::atan2(b[1] - a[1], b[0] - a[0]) / kFull + 0.5;
    const auto sector = static_cast<std::size_t>(part * static_cast<double>(sectors_.size()));
    return std::min(sector, sectors_.size() - 1);
  }

  std::vector<State> states_;
  std::vector<std::vector<std::uint32_t>> joins_;  // by node; longer than what is in use
  std::vector<Edge> edges_;
  std::vector<Near> nearest_;
  std::vector<bool> sectors_;
};

}  // namespace sidestep
