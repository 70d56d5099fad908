// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/batch/kernels.hpp"
#include "common/motion/trajectory_bounds.hpp"

namespace sidestep::batch {

/// Longest time span of a batched comparison. Trajectories that rest later are compared by is_clear().
inline constexpr double kMaxHorizon_s = 1.2;

/// A set of trajectories that are compared with one reference trajectory, several per instruction. Each
/// trajectory has a lane. All decisions are conservative with respect to the exact clearance: a lane that is
/// neither clear nor blocked is undecided, and the caller must then use is_clear().
class BatchClearance {
 public:
  explicit BatchClearance(const Kernels& kernels) : kernels_(&kernels) {}

  /// Removes all lanes. Times are stored relative to `base`, which should be close to the compared times.
  void reset(Time base);
  void add(const TrajectoryBounds& bounds, double min_separation_m);
  std::size_t size() const { return count_; }

  /// Prepares comparisons that start at `begin` and cover at least `min_span_s`.
  void sample(Time begin, double min_span_s);
  double step_s() const { return step_s_; }
  /// Compares all lanes with `reference`, which is sampled at the same times. To be clear, a lane must keep
  /// the minimum separation plus `extra_clearance_m`; to be blocked, it must be nearer than the minimum
  /// separation minus `extra_clearance_m`.
  void compare(const Track& reference, double acceleration_mps2, double extra_clearance_m);

  /// After sample(): whether the lane cannot be compared in a batch.
  bool needs_exact(std::size_t lane) const { return bit(exact_, lane) || bit(later_, lane); }
  bool is_clear(std::size_t lane) const { return bit(clear_, lane); }
  bool is_blocked(std::size_t lane) const { return bit(blocked_, lane); }
  /// Whether all lanes are clear and none needs an exact comparison.
  bool are_all_clear() const;

  Track track(std::size_t lane) const;
  /// Start of the lane's trajectory, relative to the start of the comparison.
  double start_s(std::size_t lane) const;
  double min_separation_m(std::size_t lane) const {
    return separations_[lane / kLanes].min_separation_m.lane[lane % kLanes];
  }
  double acceleration_mps2(std::size_t lane) const {
    return separations_[lane / kLanes].acceleration_mps2.lane[lane % kLanes];
  }

 private:
  static bool bit(const std::vector<std::uint8_t>& masks, std::size_t lane) {
    return (masks[lane / kLanes] >> (lane % kLanes) & 1) != 0;
  }
  std::size_t blocks() const { return (count_ + kLanes - 1) / kLanes; }
  void begin_block();

  const Kernels* kernels_;
  Time base_{};
  std::size_t count_ = 0;
  bool is_sampled_ = false;
  double begin_s_ = 0, step_s_ = 0;
  std::vector<MotionBlock> motions_;
  std::vector<SeparationBlock> separations_;
  std::vector<TrackBlock> tracks_;
  std::vector<GapBlock> gaps_;
  // One mask per block, one bit per lane. exact_: not batchable; later_: rests after kMaxHorizon_s.
  std::vector<std::uint8_t> exact_, later_, clear_, blocked_;
};

/// Thresholds for a comparison with `extra_clearance_m`. They include the tolerance of the exact clearance
/// and rounding errors.
[[nodiscard]] ComparisonSettings comparison_settings(double begin_s, double step_s, double acceleration_mps2,
                                                     double extra_clearance_m);

/// The samples of one lane.
[[nodiscard]] Track track_of(const TrackBlock& tracks, std::size_t lane);

/// The samples of a trajectory. Precondition: the bounds are batchable.
[[nodiscard]] Track track_of(const TrajectoryBounds& bounds, Time begin, double step_s);

}  // namespace sidestep::batch
