// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "idl/vision.h"
#include "vision/tracking/frame.hpp"
#include "vision/tracking/kalman.hpp"

namespace sidestep {

struct ObstacleSettings {
  double speed_mps = 1.5;              ///< that nothing exceeds
  double position_noise_m = 0.0015;    ///< standard deviation of a sight, per axis
  MotionNoise motion{2, 5};            ///< people turn as they like
  int confirm_hits = 2;                ///< sights before a track is believed
  Duration drop_after{1'000'000'000};  ///< unseen for so long, a track ends
};

/// Tracks what moves on the floor without asking and says no name: each sight goes to the nearest track that
/// can have come there, and begins a new one when there is none. Allocates nothing.
class ObstacleTracker {
 public:
  explicit ObstacleTracker(const ObstacleSettings& settings) : settings_(settings) {}

  /// The obstacles of a usable frame. Frames may come in any order; what is older than a track's last sight
  /// adds nothing to it.
  void update(const Frame& frame);
  /// The tracks that are believed and not yet dropped at a time; of too many, those seen last.
  void world_at(Time t, msg::WorldState& world) const;
  /// Sights that there was no track for.
  std::uint64_t rejected() const { return rejected_; }

 private:
  static constexpr std::size_t kMostTracks = 2 * msg::MAX_OBSTACLES;
  struct Track {
    std::uint32_t number = 0;  ///< 0: not believed yet
    int hits = 0;
    Time seen_at{};
    double radius_m = 0;
    ConstantVelocityFilter<2> filter;  ///< at seen_at
  };
  /// Takes the sights and tracks of this frame that are nearest to each other together, and out.
  void match(const Frame& frame, std::array<bool, msg::MAX_OBSTACLES>& is_taken);
  double distance_m(const Track& track, Time at, const Vec2& position_m) const;
  double gate_m(const Track& track, Time at) const;
  void follow(Track& track, Time at, const ObstacleObservation& sight);
  void begin(Time at, const ObstacleObservation& sight);
  void drop_unseen(Time now);

  ObstacleSettings settings_;
  std::array<Track, kMostTracks> tracks_;
  std::size_t count_ = 0;
  std::uint32_t numbers_ = 0;
  std::uint64_t rejected_ = 0;
};

}  // namespace sidestep
