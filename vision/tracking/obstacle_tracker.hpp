// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "common/tracking/kalman.hpp"
#include "idl/vision.hpp"
#include "vision/tracking/frame.hpp"
#include "vision/tracking/incomplete_frames.hpp"

namespace sidestep {

struct ObstacleTrackerSettings {
  double max_speed_mps = 1.5;        ///< maximum speed of an obstacle
  double position_noise_m = 0.0015;  ///< standard deviation of an observation on each axis
};

/// Tracks moving obstacles. Obstacles have no identity, so each observation updates the nearest track whose
/// obstacle could have reached it, or starts a track. Allocates only in the constructor, for incomplete
/// frames, and when more observations are within reach of tracks than in any earlier frame.
class ObstacleTracker {
 public:
  /// Enough for four cameras with full frames.
  static constexpr std::size_t kMaxTracks = std::size_t{4} * msg::MAX_OBSTACLES;

  explicit ObstacleTracker(const ObstacleTrackerSettings& settings);

  /// Updates the tracks from a usable frame. Frames may come in any order; an observation older than a
  /// track's last one does not change it.
  void update(const Frame& frame);
  /// From now on, all positions may also be off by errors with this standard deviation, however often an
  /// obstacle is observed: those of cameras that disagree.
  void set_camera_error(double position_error_m) {
    camera_variance_m2_ = position_error_m * position_error_m;
  }
  /// Forgets all obstacles, but remembers which numbers have been used.
  void forget();
  /// Writes the confirmed tracks at a time, nearest to a robot first, and the distance up to which the list
  /// is complete. See ObstacleList in idl/vision.idl. `robots` contains the robots at that time.
  void list_at(Time t, std::span<const msg::TrackedRobot> robots, msg::ObstacleList& list);
  /// Number of observations rejected because all tracks were in use.
  std::uint64_t rejected() const { return rejected_; }

 private:
  struct Track {
    std::uint32_t number = 0;  ///< 0: not yet confirmed
    int hits = 0;
    Time observed_at{};
    Duration date_uncertainty{0};  ///< maximum error of observed_at
    double radius_m = 0;
    ConstantVelocityFilter<2> filter;  ///< state at observed_at

    /// The obstacle may have moved since this time.
    Time earliest() const { return observed_at - date_uncertainty; }
  };
  /// A track, and an observation that its obstacle could have reached.
  struct Pair {
    double distance_m = 0;  ///< distance of the observation from the track's prediction
    std::uint16_t track = 0;
    std::uint16_t observation = 0;
    auto operator<=>(const Pair&) const = default;
  };
  struct ListedTrack {
    double distance_m = 0;  ///< see ObstacleList in idl/vision.idl
    const Track* track = nullptr;
  };
  /// Updates tracks from the frame's observations, nearest pairs first, and flags the observations that were
  /// used.
  void associate(const Frame& frame);
  void find_pairs(const Frame& frame);
  /// Variance of a position on each axis.
  double variance_m2(const Track& track) const {
    return track.filter.covariance()(0, 0) + camera_variance_m2_;
  }
  double predicted_distance_m(const Track& track, Time at, const Vec2& position_m) const;
  double gate_m(const Track& track, const Frame& frame) const;
  void update_track(Track& track, const Frame& frame, const ObstacleObservation& observation);
  /// False if all tracks are in use.
  [[nodiscard]] bool start_track(const Frame& frame, const ObstacleObservation& observation,
                                 int confirm_hits);
  void drop_stale_tracks(Time now);
  /// Lower bound of the obstacle's distance from the robots in robots_m_ at a time; infinite without robots.
  double min_distance_m(const Track& track, Time t) const;

  ObstacleTrackerSettings settings_;
  std::vector<Track> tracks_;
  IncompleteFrames incomplete_frames_;
  double camera_variance_m2_ = 0;
  std::uint32_t last_number_ = 0;
  std::uint64_t rejected_ = 0;
  // Working memory.
  std::array<std::uint16_t, msg::MAX_OBSTACLES> by_x_{};  // the frame's observations, sorted by x
  std::array<bool, msg::MAX_OBSTACLES> is_used_{};        // indexed by observation
  std::array<bool, kMaxTracks> is_updated_{};             // indexed by track
  std::vector<Pair> pairs_;
  std::vector<Vec2> robots_m_;
  std::vector<ListedTrack> listed_;
};

}  // namespace sidestep
