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

/// Which way point makes room when a full cache takes a new one.
enum class CacheReplacement {
  kRandom,             ///< any (Bruce and Veloso 2002)
  kOldest,             ///< the one that has been there the longest
  kLeastRecentlyUsed,  ///< the one that no plan has grown towards for the longest
  kWholePlan,          ///< all: the cache holds the last plan
};

/// States of earlier plans, to grow towards in later ones: what was a good way point a moment ago is likely
/// to be one still.
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
  void clear() { entries_.clear(); }

  /// A way point drawn at random, for a plan to grow towards; the cache is not empty.
  const State& draw(Rng& rng) { return use(any(rng)); }
  /// The same, chosen.
  const State& use(std::size_t i) {
    entries_[i].used = now_ + 1;
    return entries_[i].state;
  }

  /// A plan was found: remembers the states on it.
  void store(const std::vector<State>& plan, Rng& rng) {
    if (capacity_ == 0) return;
    ++now_;
    if (replacement_ == CacheReplacement::kWholePlan) entries_.clear();
    for (const State& state : plan) {
      if (entries_.size() < capacity_) {
        entries_.push_back({state, now_, now_});
      } else {
        entries_[replaced(rng)] = {state, now_, now_};
      }
    }
  }

 private:
  struct Entry {
    State state;
    std::uint64_t stored, used;  // with which plan
  };

  std::size_t any(Rng& rng) const { return static_cast<std::size_t>(rng.below(entries_.size())); }

  std::size_t replaced(Rng& rng) const {
    const auto oldest = [&](auto age) {
      const auto first = std::min_element(entries_.begin(), entries_.end(),
                                          [&](const Entry& a, const Entry& b) { return age(a) < age(b); });
      return static_cast<std::size_t>(first - entries_.begin());
    };
    switch (replacement_) {
      case CacheReplacement::kOldest:
        return oldest([](const Entry& e) { return e.stored; });
      case CacheReplacement::kLeastRecentlyUsed:
        // One hard plan uses all: then the order of their coming decides.
        return oldest([](const Entry& e) { return std::pair(e.used, e.stored); });
      default:
        return any(rng);
    }
  }

  std::size_t capacity_;
  CacheReplacement replacement_;
  std::vector<Entry> entries_;
  std::uint64_t now_ = 0;
};

/// The frame of planners that remember: the straight way if it is free, else what `grow` writes into the
/// plan; the states of plans that arrive are remembered.
template <PlanningDomain D, typename Grow>
void plan_and_remember(const D& domain, const typename D::State& start,
                       WaypointCache<typename D::State>& cache, Plan<typename D::State>& plan, Rng& rng,
                       const Grow& grow) {
  begin_plan(domain, start, plan);
  if (!plan_straight(domain, start, plan)) grow();
  if (plan.arrives()) cache.store(plan.states, rng);
}

}  // namespace sidestep
