// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "agents/safety/candidate_set.hpp"
#include "agents/safety/hidden_space.hpp"
#include "agents/safety/keep_out.hpp"
#include "agents/safety/moving_obstacle.hpp"
#include "agents/safety/seen_region.hpp"
#include "agents/safety/trajectory_index.hpp"
#include "agents/safety/uncontrolled_body.hpp"
#include "common/motion/validity.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The state in which the new version starts, and the desired motion from there on.
struct SearchQuery {
  Time start{};
  State at_start;
  Vec2 desired_mps2{0, 0};
  /// Time for which the acceleration is held before the stop.
  Duration hold_time{};
  std::span<const MovingObstacle> moving{};          ///< obstacles that the robot must be passively safe from
  std::span<const UncontrolledBody> uncontrolled{};  ///< bodies to stay clear of
  const Trajectory* stop = nullptr;  ///< the motion that the robot follows if no candidate is granted; not
                                     ///< null if `uncontrolled` is not empty
  std::optional<RobotId> robot{};    ///< if set, this robot's versions in the index are ignored
  /// Maximum speed, below the robot's speed limit if the clocks require it. A robot that is already faster
  /// slows down.
  double max_speed_mps = std::numeric_limits<double>::infinity();
  double creep_mps = 0;  ///< a robot that is no faster counts as being at rest
  SeenRegion seen{};     ///< region in which there are no obstacles except the obstacles in `moving`
  HiddenSpace hidden{};  ///< floor that the robot's laser did not see
  std::span<const Shape> keep_outs{};  ///< zones that the robot must not enter
  std::optional<Vec2> way_out_m{};     ///< place outside the zones that overlap at the start
  /// Accelerations tried in this order, after the desired acceleration and before random accelerations; at
  /// most kSamples.
  std::span<const Vec2> preferred_mps2{};

  /// The motion limits with the lower of the two speed limits.
  MotionLimits limited(MotionLimits limits) const {
    limits.speed_mps = std::min(limits.speed_mps, max_speed_mps);
    return limits;
  }
};

/// Clear trajectories, sorted by their distance from the desired acceleration.
struct SearchResult {
  static constexpr std::size_t kMaxCandidates = 5;
  std::array<Trajectory, kMaxCandidates> candidates;
  std::size_t count = 0;
  bool desired_is_clear = false;  ///< the first candidate is the desired acceleration itself
  int checks = 0;                 ///< number of pairs of trajectories compared
};

/// Dynamics safety search (Bruce, CMU-CS-06-181, ch. 5). Tests the desired acceleration and random
/// accelerations from A(v), the set allowed at the robot's velocity v. Each is held for `hold_time` and
/// followed by the stop manoeuvre. The search keeps the candidates that stay on the field and clear of the
/// obstacles and of every version that other robots may be executing. Allocates nothing once warm.
class SafetySearch {
 public:
  /// Number of accelerations sampled from A(v) in addition to the desired acceleration.
  static constexpr int kSamples = 48;
  /// Minimum difference between the accelerations of two candidates.
  static constexpr double kSpread_mps2 = 0.5;

  explicit SafetySearch(const FloorRules& rules, const batch::Kernels& kernels = batch::best_kernels());

  [[nodiscard]] SearchResult search(const SearchQuery& query, TrajectoryIndex& others, Rng& rng);

 private:
  /// A trajectory or a static obstacle that a candidate may come near to; one of its pointers is null.
  struct Other {
    const Trajectory* trajectory;
    const Shape* obstacle;
    double min_separation_m;  // for an obstacle: distance from its edge
    bool is_clear(const Trajectory& candidate) const;
  };
  /// Collects everything that a candidate within the disc may come near to.
  void find_nearby(const SearchQuery& query, const Circle& disc, TrajectoryIndex& others);
  /// Collects the blocked cells of the map that intersect a disc.
  void find_cells(const Circle& disc);
  /// Collects the moving obstacles that could reach a candidate within the disc before it is at rest.
  void find_moving(const SearchQuery& query, const Circle& disc);
  /// Collects the frontiers from which a person could reach a candidate within the disc before it is at rest.
  void find_hidden(const SearchQuery& query, const Circle& disc);
  void compare(const SearchQuery& query, const TrajectoryBounds& desired, double extra_clearance_m,
               int& checks);
  bool is_allowed(const Trajectory& trajectory, bool is_certainly_clear) const;

  FloorRules rules_;
  // Parallel to rules_.obstacles; a circle counts as a trajectory that rests at its centre.
  std::vector<TrajectoryBounds> obstacles_;
  CandidateSet candidates_;
  std::vector<std::uint32_t> found_indices_;
  batch::BatchClearance clearance_;  // lane i corresponds to others_[i]
  std::vector<Other> others_;        // all trajectories and circles that may be near
  std::vector<Other> edges_;         // all other obstacles that may be near
  std::vector<Shape> cells_;   // blocked cells of the map that may be near, as a few boxes; also in edges_
  std::vector<Other> nearby_;  // the subset of others_ that the candidates are compared with
  std::vector<Other> exact_;   // the subset of nearby_ that needs exact comparisons
  bool is_near_border_ = false;
  std::vector<MovingObstacle> moving_;             // obstacles of the query that may be near
  std::vector<Frontier> frontiers_, closed_gaps_;  // borders of the query that may be near
  KeepOut keep_out_;
  std::vector<Vec2> preferred_;  // preferred accelerations of the query, limited
};

/// An acceleration that is held for `hold_time`, followed by the stop manoeuvre.
[[nodiscard]] Trajectory accelerate_then_stop(Time start, const State& at_start,
                                              const Vec2& acceleration_mps2, Duration hold_time,
                                              double deceleration_mps2);

}  // namespace sidestep
