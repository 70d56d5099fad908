// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/motion/moving_obstacle.hpp"
#include "common/motion/validity.hpp"
#include "common/motion/version.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// What the search is asked: where the robot will be when the new version starts, and what it would like to
/// do then.
struct SearchQuery {
  Time start{};
  State at_start;
  Vec2 wish_mps2{0, 0};
  Duration phase{};  ///< how long the acceleration is held before the stop manoeuvre begins
  std::span<const MovingObstacle> moving{};  ///< to be at rest before
};

struct SearchSettings {
  int samples = 48;          ///< accelerations drawn from A(v) besides the wish
  double spread_mps2 = 0.5;  ///< candidates of one proposal differ by at least this
};

/// Clear trajectories, the one nearest to the wish first.
struct SearchResult {
  static constexpr std::size_t kMaxCandidates = 5;
  std::array<Trajectory, kMaxCandidates> candidates;
  std::size_t count = 0;
  bool wish_is_clear = false;  ///< the first candidate is the wish itself
  int checks = 0;              ///< pairs of trajectories compared
};

/// Dynamics safety search (Bruce, ch. 5): the wished acceleration first, then random ones from A(v), each
/// held for one phase and followed by the stop manoeuvre; kept are those that stay on the field and clear of
/// the obstacles and of everything that others may be executing, ranked by their distance from the wish.
/// Allocates nothing once warm.
class SafetySearch {
 public:
  SafetySearch(const FloorRules& rules, const SearchSettings& settings);

  SearchResult search(const SearchQuery& query, std::span<const Version> others, Rng& rng);

 private:
  struct Sample {
    Vec2 acceleration_mps2;
    double distance2;  // from the wish, squared
  };
  void draw_samples(const SearchQuery& query, Rng& rng);
  void find_near(const SearchQuery& query, std::span<const Version> others);
  bool is_allowed(const Trajectory& trajectory, int& checks);

  FloorRules rules_;
  SearchSettings settings_;
  std::vector<Sample> samples_;
  std::vector<const Version*> near_;
};

/// An acceleration held for a phase, then the stop manoeuvre.
Trajectory accelerate_then_stop(Time start, const State& at_start, const Vec2& acceleration_mps2,
                                Duration phase, double deceleration_mps2);

}  // namespace sidestep
