// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "vision/tracking/kalman.hpp"

namespace sidestep {

/// How one kind of thing moves and is seen. The defaults fit a robot.
struct TrackModel {
  double position_noise_m = 0.0015;  ///< standard deviation of a sight, per axis
  double heading_noise_rad = 0.005;  ///< standard deviation of a sight
  MotionNoise motion{0.3, 3};        ///< robots brake with 5 m/s²: 5 / sqrt(3) as a standard deviation
  MotionNoise turning{10, 10};
  double rolling_mps2 = 0;       ///< friction
  double start_speed_mps = 1.5;  ///< standard deviation of the velocity at the first sight, per axis
  double start_turn_radps = 5;   ///< the same for the heading's rate
  double gate_sigma = 5;         ///< a sight farther from the track than this is not taken for it
  double gate_m = 0.09;          ///< and neither is one farther than this, however uncertain the track is
  int confirm_hits = 3;          ///< consistent sights before a track is believed
  int near_hits = 2;  ///< consistent sights within gate_m of a track that was moved: it goes on there
  Duration max_gap{100'000'000};  ///< between two consistent sights of a track that is not yet believed
  Duration relocate_after{150'000'000};  ///< unseen where it was for so long, a track may go on elsewhere
  Duration drop_after{1'000'000'000};    ///< unseen for so long, a track ends
};

/// One camera's sight of one thing.
struct Sight {
  Time captured_at{};
  std::uint32_t camera = 0;
  Vec2 position_m{0, 0};
  double heading_rad = 0;
};

struct PoseFilter {
  ConstantVelocityFilter<2> position;
  ConstantVelocityFilter<1> heading;
};

/// A pose with a variance, extrapolated from the last sight.
struct Estimate {
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
  double heading_rad = 0;
  double angular_radps = 0;
  double position_variance_m2 = 0;
  double velocity_variance_m2ps2 = 0;
};

/// All that the sights of one thing, in order of capture, say about it.
struct TrackState {
  bool is_confirmed = false;
  PoseFilter filter;   ///< at seen.captured_at; meaningful when confirmed
  Sight seen;          ///< mean of the latest sights taken: unfiltered, so that acceleration cannot bias it
  int seen_count = 0;  ///< sights in that mean, all captured at once
  int candidate_hits = 0;  ///< consistent sights elsewhere, or before the track is believed
  Time candidate_at{};
  PoseFilter candidate;
  std::uint64_t rejected = 0;  ///< sights that turned out to belong to nothing
};

/// The state after one more sight, captured no earlier than those before it.
TrackState advanced(const TrackState& state, const Sight& sight, const TrackModel& model);

/// Where the thing is at a time; nothing when it is not believed or was last seen too long ago.
std::optional<Estimate> estimate_at(const TrackState& state, Time t, const TrackModel& model);

/// The track of one thing from sights that come in any order: it keeps the latest ones with the state after
/// each, and replays from where a late one belongs. So the result depends on what was seen and when, not on
/// when it arrived.
class Track {
 public:
  /// False for a sight that it has already, or that is older than all it keeps.
  bool add(const Sight& sight, const TrackModel& model);
  const TrackState& state() const { return size_ == 0 ? base_ : entry(size_ - 1).after; }
  std::uint64_t rejected() const { return state().rejected + too_late_; }

 private:
  /// At 60 Hz and two cameras 270 ms: more than frames' delays differ by.
  static constexpr std::size_t kCapacity = 32;
  struct Entry {
    Sight sight;
    TrackState after;
  };
  Entry& entry(std::size_t i) { return entries_[(first_ + i) % kCapacity]; }
  const Entry& entry(std::size_t i) const { return entries_[(first_ + i) % kCapacity]; }

  TrackState base_;  ///< after everything that is no longer kept
  std::array<Entry, kCapacity> entries_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t too_late_ = 0;
};

}  // namespace sidestep
