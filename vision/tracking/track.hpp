// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "common/tracking/kalman.hpp"

namespace sidestep {

/// The motion and observation model of one kind of object. The defaults fit a robot.
struct TrackModel {
  double position_noise_m = 0.0015;  ///< standard deviation of an observation on each axis
  double heading_noise_rad = 0.005;  ///< standard deviation of an observation
  MotionNoise motion{0.3, 3};        ///< robots brake at 5 m/s²: 5 / sqrt(3) as a standard deviation
  MotionNoise turning{10, 10};
  double rolling_mps2 = 0;  ///< deceleration by rolling friction
  /// Standard deviation of the velocity at the first observation, on each axis.
  double start_speed_mps = 1.5;
  double start_turn_radps = 5;  ///< standard deviation of the heading's rate at the first observation
  double gate_sigma = 5;        ///< maximum Mahalanobis distance of an observation from the track
  double gate_m = 0.09;         ///< maximum distance of an observation, regardless of the track's uncertainty
  int confirm_hits = 3;         ///< number of consistent observations before a track is confirmed
  /// Number of consistent observations within gate_m that move a displaced track.
  int displaced_hits = 2;
  /// Maximum time between two consistent observations of an unconfirmed track.
  Duration max_gap{100'000'000};
  Duration relocate_after{150'000'000};  ///< time without an observation before a track may move elsewhere
  Duration drop_after{1'000'000'000};    ///< time without an observation after which a track ends
};

/// One camera's observation of one object.
struct Observation {
  Time captured_at{};
  std::uint32_t camera = 0;
  Vec2 position_m{0, 0};
  double heading_rad = 0;
  Duration date_uncertainty{0};  ///< maximum error of captured_at
};

struct PoseFilter {
  ConstantVelocityFilter<2> position;
  ConstantVelocityFilter<1> heading;
};

/// A pose with its variance, extrapolated from the last observation.
struct Estimate {
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
  double heading_rad = 0;
  double angular_radps = 0;
  double position_variance_m2 = 0;
  double velocity_variance_m2ps2 = 0;
};

/// The state of a track after a sequence of observations in order of capture.
struct TrackState {
  bool is_confirmed = false;
  PoseFilter filter;  ///< state at last.captured_at; valid if confirmed
  Observation last;   ///< mean of the latest accepted observations; unfiltered, so that acceleration does not
                      ///< bias it
  int last_count = 0;      ///< number of observations averaged in `last`, all captured at the same time
  int candidate_hits = 0;  ///< number of consistent observations elsewhere, or before the track is confirmed
  Time candidate_at{};
  PoseFilter candidate;
  std::uint64_t rejected = 0;  ///< number of observations that were not accepted
};

/// The state after one more observation. Precondition: no previous observation was captured later.
[[nodiscard]] TrackState advanced(const TrackState& state, const Observation& observation,
                                  const TrackModel& model);

/// Whether the latest consistent observations of a confirmed track are elsewhere: the robot may have been
/// displaced, or its camera mistakes another object for it.
[[nodiscard]] bool is_seen_elsewhere(const TrackState& state, const TrackModel& model);

/// The estimate at a time; nullopt if the track is not confirmed or was last observed too long ago.
[[nodiscard]] std::optional<Estimate> estimate_at(const TrackState& state, Time t, const TrackModel& model);

/// The track of one object from observations that arrive in any order. Stores the latest observations with
/// the state after each. When a late observation arrives, it is inserted and the later ones are replayed. The
/// result therefore does not depend on the order of arrival.
class Track {
 public:
  /// Returns false for a duplicate, and for an observation that is older than all stored ones.
  bool add(const Observation& observation, const TrackModel& model);
  const TrackState& state() const { return size_ == 0 ? base_ : entry(size_ - 1).after; }
  std::uint64_t rejected() const { return state().rejected + too_late_; }

 private:
  /// 270 ms at 60 Hz and two cameras, more than the spread of frame delays.
  static constexpr std::size_t kCapacity = 32;
  struct Entry {
    Observation observation;
    TrackState after;
  };
  Entry& entry(std::size_t i) { return entries_[(first_ + i) % kCapacity]; }
  const Entry& entry(std::size_t i) const { return entries_[(first_ + i) % kCapacity]; }

  TrackState base_;  ///< state after all observations that are older than the stored ones
  std::array<Entry, kCapacity> entries_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t too_late_ = 0;
};

}  // namespace sidestep
