// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "agents/planning/domain/plan.hpp"

namespace sidestep {

struct SmoothingSettings {
  std::size_t rounds = 6;     ///< at most, each to and fro
  double least_gain = 0.002;  ///< of the length, or it was the last round
  std::size_t halvings = 6;   ///< of a motion, to find how far along it the follower sees
};

/// Leader-follower smoothing (Bruce 2006, section 4.7): a leader walks along the plan, as long as the
/// follower can go straight to it; where it cannot any more, the follower goes to where it still could, and
/// the leader walks on. Done to and fro, the way is drawn tight round what it passes. Keeps its memory.
template <StraightDomain D>
class LeaderFollower {
 public:
  using State = typename D::State;

  explicit LeaderFollower(const SmoothingSettings& settings = {}) : settings_(settings) {}

  /// Makes the plan's way shorter, or leaves it; it stays valid, and its ends stay.
  void smooth(const D& domain, Plan<State>& plan) {
    smoothed_.reserve(plan.states.size());
    turned_.reserve(plan.states.size());
    for (std::size_t round = 0; round < settings_.rounds && plan.states.size() > 2; ++round) {
      follow(domain, plan.states);
      std::reverse(smoothed_.begin(), smoothed_.end());
      turned_.swap(smoothed_);
      follow(domain, turned_);
      std::reverse(smoothed_.begin(), smoothed_.end());
      const double length = length_of(domain, smoothed_);
      const bool is_last = length > plan.length * (1 - settings_.least_gain);
      if (length < plan.length) {
        plan.states = smoothed_;
        plan.length = length;
      }
      if (is_last) return;
    }
  }

 private:
  /// Writes the follower's way.
  void follow(const D& domain, const std::vector<State>& way) {
    smoothed_.clear();
    smoothed_.push_back(way.front());
    // The leader stands on way[at], or between it and the next.
    std::size_t at = 1;
    State leader = way[1];
    for (;;) {
      const State follower = smoothed_.back();
      while (at + 1 < way.size() && domain.check(follower, way[at + 1])) leader = way[++at];
      if (at + 1 == way.size()) break;
      leader = farthest_seen(domain, follower, leader, way[at + 1]);
      if (!(leader == follower)) smoothed_.push_back(leader);
      // The next corner is seen from where the follower goes now.
      leader = way[++at];
    }
    smoothed_.push_back(way.back());
  }

  /// Between a state that the follower sees and one that it does not.
  State farthest_seen(const D& domain, const State& follower, const State& seen, const State& hidden) const {
    State last = seen;
    double low = 0, high = 1;
    for (std::size_t i = 0; i < settings_.halvings; ++i) {
      const double middle = (low + high) / 2;
      const State state = domain.between(seen, hidden, middle);
      if (domain.check(follower, state)) {
        low = middle;
        last = state;
      } else {
        high = middle;
      }
    }
    return last;
  }

  SmoothingSettings settings_;
  std::vector<State> smoothed_, turned_;
};

}  // namespace sidestep
