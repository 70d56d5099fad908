// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "agents/planning/domain/plan.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Replacement strategy: which waypoint a full cache drops for a new waypoint.
enum class CacheReplacement {
  kRandom,             ///< a random waypoint (Bruce and Veloso 2002)
  kOldest,             ///< the waypoint stored first
  kLeastRecentlyUsed,  ///< the waypoint least recently used as a growth target
  kWholePlan,          ///< all waypoints, so that the cache contains only the last plan
};

/// States of earlier plans that later plans grow towards, since good waypoints change little between
/// successive queries.
template <typename State>
class WaypointCache {
 public:
  explicit WaypointCache(std::size_t capacity, CacheReplacement replacement = CacheReplacement::kRandom)
      : capacity_(capacity), replacement_(replacement) {
    entries_.reserve(capacity);
  }

  bool is_empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  const State& operator[](std::size_t i) const { return entries_[i].state; }

  /// A random waypoint to grow towards. Requires a non-empty cache.
  const State& sample(Rng& rng) { return use(random_index(rng)); }
  /// The waypoint with an index, marked as used.
  const State& use(std::size_t i) {
    entries_[i].used = now_ + 1;
    return entries_[i].state;
  }

  /// Stores the states of a solved plan.
  void store(const std::vector<State>& plan, Rng& rng) {
    if (capacity_ == 0) return;
    ++now_;
    if (replacement_ == CacheReplacement::kWholePlan) entries_.clear();
    for (const State& state : plan) {
      if (entries_.size() < capacity_) {
        entries_.push_back({state, now_, now_});
      } else {
        entries_[replaced_index(rng)] = {state, now_, now_};
      }
    }
  }

 private:
  struct Entry {
    State state;
    std::uint64_t stored, used;  // number of the plan that stored it, and of the last plan that used it
  };

  std::size_t random_index(Rng& rng) const { return static_cast<std::size_t>(rng.below(entries_.size())); }

  std::size_t replaced_index(Rng& rng) const {
    const auto oldest = [&](auto age) {
      const auto first = std::min_element(entries_.begin(), entries_.end(),
                                          [&](const Entry& a, const Entry& b) { return age(a) < age(b); });
      return static_cast<std::size_t>(first - entries_.begin());
    };
    switch (replacement_) {
      case CacheReplacement::kOldest:
        return oldest([](const Entry& e) { return e.stored; });
      case CacheReplacement::kLeastRecentlyUsed:
        // One hard plan may use all waypoints; in that case the waypoint stored first is dropped.
        return oldest([](const Entry& e) { return std::pair(e.used, e.stored); });
      default:
        return random_index(rng);
    }
  }

  std::size_t capacity_;
  CacheReplacement replacement_;
  std::vector<Entry> entries_;
  std::uint64_t now_ = 0;
};

/// The common part of planners with a cache. Tries the straight path if `tries_straight_line`. Unless that
/// path is free, calls `grow`, which writes the plan. Stores the states of successful plans in the cache.
template <PlanningDomain D, typename Grow>
void plan_and_remember(const D& domain, const typename D::State& start,
                       WaypointCache<typename D::State>& cache, Plan<typename D::State>& plan, Rng& rng,
                       bool tries_straight_line, const Grow& grow) {
  begin_plan(domain, start, plan);
  if (!tries_straight_line || !plan_straight(domain, start, plan)) grow();
  if (plan.arrives()) cache.store(plan.states, rng);
}

}  // namespace sidestep
