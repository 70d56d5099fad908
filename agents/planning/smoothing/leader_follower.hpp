// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// Leader-follower smoothing (Bruce 2006, section 4.6.1): a leader advances along the path while the follower
/// can reach it on a straight motion. When it no longer can, the follower moves to the last visible state,
/// and the leader advances again. Repeated forwards and backwards, this pulls the path tight around
/// obstacles. Reuses its memory between plans.
template <StraightDomain D>
class LeaderFollower {
 public:
  using State = typename D::State;

  /// Shortens the plan's path, or leaves it unchanged. The path stays valid and keeps its ends.
  void smooth(const D& domain, Plan<State>& plan) {
    smoothed_.reserve(plan.states.size());
    reversed_.reserve(plan.states.size());
    for (std::size_t round = 0; round < kRounds && plan.states.size() > 2; ++round) {
      follow(domain, plan.states);
      std::reverse(smoothed_.begin(), smoothed_.end());
      reversed_.swap(smoothed_);
      follow(domain, reversed_);
      std::reverse(smoothed_.begin(), smoothed_.end());
      const double length = length_of(domain, smoothed_);
      const bool is_last = length > plan.length * (1 - kMinGain);
      if (length < plan.length) {
        plan.states = smoothed_;
        plan.length = length;
      }
      if (is_last) return;
    }
  }

 private:
  /// Writes the follower's path to smoothed_.
  void follow(const D& domain, const std::vector<State>& path) {
    smoothed_.clear();
    smoothed_.push_back(path.front());
    // The leader is at path[index], or between it and the next state.
    std::size_t index = 1;
    State leader = path[1];
    for (;;) {
      const State follower = smoothed_.back();
      while (index + 1 < path.size() && domain.check(follower, path[index + 1])) leader = path[++index];
      if (index + 1 == path.size()) break;
      leader = farthest_visible(domain, follower, leader, path[index + 1]);
      if (!(leader == follower)) smoothed_.push_back(leader);
      // The next state is visible from the follower's new position.
      leader = path[++index];
    }
    smoothed_.push_back(path.back());
  }

  /// The last state visible to the follower between a visible and a hidden state.
  State farthest_visible(const D& domain, const State& follower, const State& visible,
                         const State& hidden) const {
    State last = visible;
    double low = 0, high = 1;
    for (std::size_t i = 0; i < kHalvings; ++i) {
      const double fraction = (low + high) / 2;
      const State state = domain.between(visible, hidden, fraction);
      if (domain.check(follower, state)) {
        low = fraction;
        last = state;
      } else {
        high = fraction;
      }
    }
    return last;
  }

  static constexpr std::size_t kRounds = 6;  // maximum number of rounds; each runs forwards and backwards
  static constexpr double kMinGain = 0.002;  // a smaller relative reduction of the length ends smoothing
  // Number of bisections of a motion to find the farthest state visible from the follower.
  static constexpr std::size_t kHalvings = 6;

  std::vector<State> smoothed_, reversed_;
};

}  // namespace sidestep
