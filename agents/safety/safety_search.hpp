// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "agents/safety/candidate_choice.hpp"
#include "agents/safety/trajectory_index.hpp"
#include "agents/safety/moving_obstacle.hpp"
#include "common/motion/validity.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// What the search is asked: where the robot will be when the new version starts, and what it would like to
/// do then.
struct SearchQuery {
  Time start{};
  State at_start;
  Vec2 desired_mps2{0, 0};
  Duration phase{};                          ///< how long the acceleration is held before the stop
  double inflation_m = 0;                        ///< how much larger than its radius the robot has to be taken
  std::span<const MovingObstacle> moving{};  ///< to be at rest before
  std::optional<RobotId> robot{};  ///< whose own versions, if they are among the others, do not count
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
  bool desired_is_clear = false;  ///< the first candidate is the wish itself
  int checks = 0;              ///< pairs of trajectories compared
};

/// Dynamics safety search (Bruce, ch. 5): the wished acceleration first, then random ones from A(v), each
/// held for one phase and followed by the stop manoeuvre; kept are those that stay on the field and clear of
/// the obstacles and of everything that others may be executing, ranked by their distance from the wish.
/// Allocates nothing once warm.
class SafetySearch {
 public:
  SafetySearch(const FloorRules& rules, const SearchSettings& settings,
               const batch::Kernels& kernels = batch::best_kernels());

  SearchResult search(const SearchQuery& query, TrajectoryIndex& others, Rng& rng);

 private:
  /// Somebody or something that a candidate may come near to.
  struct Other {
    const Trajectory* trajectory;  // nullptr: an obstacle
    Vec2 centre_m;
    double min_separation_m;
    bool is_clear(const Trajectory& candidate) const;
  };
  void draw(const SearchQuery& query, const Vec2& desired_mps2, Rng& rng);
  void find_near(const SearchQuery& query, const Circle& disc, TrajectoryIndex& others);
  void compare(const SearchQuery& query, const TrajectoryBounds& desired, double extra_clearance_m, int& checks);
  bool is_allowed(const Trajectory& trajectory, bool is_certainly_clear) const;

  FloorRules rules_;
  SearchSettings settings_;
  std::vector<TrajectoryBounds> obstacles_;  // as rules_.obstacles
  CandidateChoice choice_;
  std::vector<std::uint32_t> found_;
  batch::Lanes lanes_;               // of the others who may be near, and
  std::vector<Other> others_;        // who they are;
  std::vector<Other> near_, exact_;  // those who are near, and those of them whom batches cannot compare
  bool is_near_border_ = false;
};

/// An acceleration held for a phase, then the stop manoeuvre.
Trajectory accelerate_then_stop(Time start, const State& at_start, const Vec2& acceleration_mps2,
                                Duration phase, double deceleration_mps2);

}  // namespace sidestep
