// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/batch/kernels.hpp"
#include "common/motion/trajectory_bounds.hpp"

namespace sidestep::batch {

/// Comparisons do not look farther ahead than this: what rests later is compared one by one.
inline constexpr double kLongest_s = 1.2;

/// The trajectories that one is compared with, and what comes of it. Every decision is on the safe side of
/// the exact clearance: what is neither clear nor blocked has to be asked is_clear().
class Lanes {
 public:
  explicit Lanes(const Kernels& kernels) : kernels_(&kernels) {}

  /// Forgets all; times are counted from `base` on, which should be near to what is compared.
  void restart(Time base);
  void add(const TrajectoryBounds& outline, double min_separation_m);
  std::size_t size() const { return count_; }

  /// Prepares comparisons that begin at a time and last for at least so long.
  void sample(Time begin, double at_least_s);
  double step_s() const { return step_s_; }
  /// Compares all with one, sampled from the same begin on, as if every distance to keep were larger by
  /// extra_clearance_m for what is clear, and smaller for what is blocked.
  void compare(const Track& one, double acceleration_mps2, double extra_clearance_m);

  /// After sample(): the lane cannot be compared like this.
  bool is_exact(std::size_t lane) const { return bit(exact_, lane) || bit(later_, lane); }
  bool is_clear(std::size_t lane) const { return bit(clear_, lane); }
  bool is_blocked(std::size_t lane) const { return bit(blocked_, lane); }
  /// Eight lanes' bits: those of is_clear(), and those of lanes that batches do not decide.
  unsigned clear_bits(std::size_t block) const { return clear_[block]; }
  unsigned open_bits(std::size_t block) const {
    return (~(clear_[block] | blocked_[block]) | exact_[block] | later_[block]) & 0xffu;
  }
  /// Whether all lanes are clear, and none has to be compared exactly.
  bool are_all_clear() const;

  Track track(std::size_t lane) const;
  /// After the begin of the comparison.
  double start_s(std::size_t lane) const;
  double min_separation_m(std::size_t lane) const { return keeps_[lane / kLanes].min_separation_m.lane[lane % kLanes]; }
  double acceleration_mps2(std::size_t lane) const {
    return keeps_[lane / kLanes].acceleration_mps2.lane[lane % kLanes];
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
  std::vector<KeepBlock> keeps_;
  std::vector<TrackBlock> tracks_;
  std::vector<GapBlock> gaps_;
  std::vector<std::uint8_t> exact_, later_, clear_, blocked_;  // by block, a bit for each lane
};

/// What comparisons with this much room decide by.
ComparisonSettings comparison(double begin_s, double step_s, double acceleration_mps2, double extra_clearance_m);

/// One lane's samples.
Track track_of(const TrackBlock& tracks, std::size_t lane);

/// A trajectory's samples. Precondition: the outline is plain.
Track track_of(const TrajectoryBounds& outline, Time begin, double step_s);

}  // namespace sidestep::batch
