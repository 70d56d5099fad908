// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "idl/vision.hpp"
#include "vision/tracking/frame.hpp"
#include "vision/tracking/kalman.hpp"

namespace sidestep {

struct ObstacleTrackerSettings {
  double max_speed_mps = 1.5;          ///< of an obstacle
  double position_noise_m = 0.0015;    ///< standard deviation of an observation, per axis
  MotionNoise motion{2, 5};            ///< people turn abruptly
  int confirm_hits = 2;                ///< observations before a track is confirmed
  Duration drop_after{1'000'000'000};  ///< time without an observation after which a track ends
};

/// Tracks moving obstacles, which have no identity: each observation updates the nearest track that can have
/// reached it, or starts a track. Allocates nothing.
class ObstacleTracker {
 public:
  explicit ObstacleTracker(const ObstacleTrackerSettings& settings) : settings_(settings) {}

  /// Updates the tracks from a usable frame. Frames may come in any order; an observation older than a
  /// track's last one does not change it.
  void update(const Frame& frame);
  /// Writes the confirmed tracks that are current at a time; if there are too many, those observed last.
  void world_at(Time t, msg::WorldState& world) const;
  /// Observations rejected because all tracks were in use.
  std::uint64_t rejected() const { return rejected_; }

 private:
  static constexpr std::size_t kMaxTracks = std::size_t{2} * msg::MAX_OBSTACLES;
  struct Track {
    std::uint32_t number = 0;  ///< 0: not confirmed yet
    int hits = 0;
    Time observed_at{};
    double radius_m = 0;
    ConstantVelocityFilter<2> filter;  ///< at observed_at
  };
  /// Updates tracks from the frame's observations, nearest pairs first, and flags the observations used.
  void associate(const Frame& frame, std::array<bool, msg::MAX_OBSTACLES>& is_used);
  double predicted_distance_m(const Track& track, Time at, const Vec2& position_m) const;
  double gate_m(const Track& track, Time at) const;
  void update_track(Track& track, Time at, const ObstacleObservation& observation);
  void start_track(Time at, const ObstacleObservation& observation);
  void drop_stale_tracks(Time now);

  ObstacleTrackerSettings settings_;
  std::array<Track, kMaxTracks> tracks_;
  std::size_t count_ = 0;
  std::uint32_t last_number_ = 0;
  std::uint64_t rejected_ = 0;
};

}  // namespace sidestep
