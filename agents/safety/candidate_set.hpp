// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "agents/batch/batch_clearance.hpp"
#include "agents/batch/dispatch.hpp"
#include "common/motion/limits.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The candidate accelerations of one search, eight per block. They are sampled, compared with nearby
/// trajectories, and taken in order of their distance from the desired acceleration.
class CandidateSet {
 public:
  CandidateSet(int samples, const MotionLimits& limits, const batch::Kernels& kernels);

  /// Makes the desired acceleration candidate 0, and fills the rest with samples of A(v), the accelerations
  /// allowed at this velocity. Samples are limited such that they may be held for `hold_time` without
  /// exceeding the maximum speed. Precondition: the desired acceleration obeys the limits.
  void sample_accelerations(const Vec2& velocity_mps, const Vec2& desired_mps2, Duration hold_time,
                            double max_speed_mps, Rng& rng);
  /// Replaces samples with these accelerations, which are taken in this order after the desired acceleration.
  /// Precondition: they obey the limits.
  void prefer(std::span<const Vec2> accelerations_mps2);
  /// Prepares for compare(): samples the motions that start in `at_start`, hold an acceleration for `hold_s`,
  /// and then stop.
  void sample_motions(const State& at_start, double hold_s, double step_s);
  /// Excludes candidates that certainly come nearer than `min_separation_m` to the track, which begins at
  /// `start_s`.
  void compare(const batch::Track& other, double start_s, double min_separation_m,
               double other_acceleration_mps2);

  /// Removes the candidate nearest to the desired acceleration and returns its index. Also removes all
  /// candidates nearer than `spread_mps2` to a candidate that was accepted since the last call.
  std::optional<std::size_t> take_nearest(double spread_mps2);
  /// Accepts the candidate that was last taken.
  void accept(std::size_t index) { accepted_ = index; }

  Vec2 acceleration(std::size_t index) const;
  bool is_certainly_clear(std::size_t index) const;
  std::size_t size() const { return count_; }

 private:
  const batch::Kernels* kernels_;
  MotionLimits limits_;
  std::size_t count_;
  std::vector<double> sampled_x_, sampled_y_;
  std::vector<batch::AccelerationBlock> accelerations_;
  std::vector<batch::MotionBlock> motions_;
  std::vector<batch::TrackBlock> tracks_;
  std::vector<batch::GapBlock> gaps_;
  double step_s_ = 0;
  std::optional<std::size_t> accepted_;
};

}  // namespace sidestep
