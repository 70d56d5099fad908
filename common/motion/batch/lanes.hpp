// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/motion/batch/kernels.hpp"
#include "common/motion/outline.hpp"

namespace sidestep::batch {

/// The times at which a comparison samples: kSamples from `begin` on.
struct Grid {
  Time begin{};
  double step_s = 0;
};

/// Comparisons do not look farther ahead than this: what rests later is compared one by one.
inline constexpr double kLongest_s = 1.2;

/// How far a relative motion may be from its chords.
double deviation_m(double relative_acceleration_mps2, double step_s);

/// The trajectories that one is compared with, and what comes of it. Every decision is on the safe side of
/// the exact clearance: what is neither clear nor blocked has to be asked is_clear().
class Lanes {
 public:
  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  /// Precondition: the outline is plain.
  void add(const Outline& outline, double keep_m, Time begin);
  /// Until the last of them rests.
  double seconds() const;

  void sample(const Kernels& kernels, double step_s);
  /// Compares all with one motion that begins at the grid's begin, as if it were `room_m` larger for what is
  /// clear, and smaller for what is blocked.
  void compare(const Kernels& kernels, const Track& one, double acceleration_mps2, double room_m);

  bool is_clear(std::size_t lane) const { return gaps_[lane / kLanes].clear.lane[lane % kLanes] >= 0; }
  bool is_blocked(std::size_t lane) const { return gaps_[lane / kLanes].blocked.lane[lane % kLanes] < 0; }

  Track track(std::size_t lane) const;
  double start_s(std::size_t lane) const { return bounds_[lane / kLanes].start_s.lane[lane % kLanes]; }
  double keep_m(std::size_t lane) const { return keep_m_[lane]; }
  double acceleration_mps2(std::size_t lane) const { return acceleration_mps2_[lane]; }

 private:
  std::size_t blocks() const { return (count_ + kLanes - 1) / kLanes; }
  void grow();

  std::size_t count_ = 0;
  double step_s_ = 0;
  std::vector<MotionBlock> motions_;
  std::vector<TrackBlock> tracks_;
  std::vector<BoundsBlock> bounds_;
  std::vector<GapBlock> gaps_;
  std::vector<double> keep_m_, acceleration_mps2_, rest_s_;
};

/// Squares what clears and what blocks at a distance to keep, for chords this far from the motion.
void set_bounds(BoundsBlock& bounds, std::size_t lane, double keep_m, double deviation_m, double room_m);

/// One lane's samples.
Track track_of(const TrackBlock& tracks, std::size_t lane);

}  // namespace sidestep::batch
