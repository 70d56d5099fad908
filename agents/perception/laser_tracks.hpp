// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/perception/local_grid.hpp"
#include "agents/perception/prior_map.hpp"
#include "agents/perception/scan_clusters.hpp"
#include "common/tracking/kalman.hpp"

namespace sidestep {

/// An object that is not known to be stationary.
struct LaserTrack {
  std::uint32_t number = 0;
  Vec2 position_m{0, 0};  ///< position of the centre at seen_at
  Vec2 velocity_mps{0, 0};
  double radius_m = 0;
  double position_error_m = 0, velocity_error_mps = 0;  ///< standard deviations, on each axis
  Time seen_at{};
  bool is_moving = false;
};

/// Distinguishes moving from stationary objects. Hits that neither the map nor the stationary part of the
/// local grid explains form clusters, and these update tracks (the nearest pair first, constant-velocity
/// Kalman filter).
///
/// As a robot drives, it sees changing parts of walls, for example through a door or beside a person, and
/// these look like moving objects. Therefore speed alone is not enough. A track counts as moving only if it
/// has also covered some distance, and either its current place was seen free earlier, or its first place was
/// seen free later. A part of a wall does not meet this condition: it looks like a disc that is half inside
/// the wall, where no beam ever passes. A person who stops keeps the track, and is not taken for a wall while
/// the track lasts.
class LaserTracks {
 public:
  static constexpr std::size_t kMaxTracks = 256;

  LaserTracks();

  /// Processes a scan, which the grid must not have processed yet. Returns false and changes nothing if the
  /// scan is not newer than the last scan. Does not allocate once warm.
  bool update(const LaserBeams& beams, const LocalGrid& grid, const PriorMap& floor = {});

  /// The confirmed tracks.
  std::span<const LaserTrack> tracks() const { return listed_; }
  /// Whether the hit of a beam in the last scan belongs to something stationary.
  bool is_standing(int beam) const { return kinds_[static_cast<std::size_t>(beam)] == kStanding; }

 private:
  static constexpr std::uint8_t kOther = 0, kStanding = 1, kUnexplained = 2;

  struct Entry {
    std::uint32_t number = 0;
    int scans = 0;
    int evidence = 0;  // number of scans that show that it has moved
    Time started_at{}, seen_at{};
    double radius_m = 0;
    ConstantVelocityFilter<2> filter;  // state at seen_at
    Vec2 start_m{0, 0};                // position at started_at
    bool has_moved() const { return evidence >= kEvidence; }
    static constexpr int kEvidence = 3;
  };
  struct Pair {
    double distance_m = 0;
    std::size_t entry = 0, cluster = 0;
  };

  void classify(const LaserBeams& beams, const LocalGrid& grid, const PriorMap& floor);
  bool is_explained(const Vec2& hit_m, const LocalGrid& grid) const;
  bool is_of_moving_track(const Vec2& hit_m, Time occupied_since) const;
  Vec2 predicted_m(const Entry& entry) const;
  Vec2 centre_m(const ScanCluster& cluster, double radius_m) const;
  bool is_trackable(const ScanCluster& cluster) const;
  void associate(const LocalGrid& grid);
  void observe(Entry& entry, const ScanCluster& cluster, const LocalGrid& grid);
  bool shows_motion(const Entry& entry, const LocalGrid& grid) const;
  bool was_crossed(const Circle& disc, Time since, const LocalGrid& grid) const;
  bool is_fast(const Entry& entry) const;
  void start(const ScanCluster& cluster);
  void list();

  ScanClusters clusters_;
  Time now_ = Time::min();
  std::uint32_t last_number_ = 0;
  std::vector<Entry> entries_;
  std::vector<LaserTrack> listed_;
  // Working memory.
  std::vector<std::uint8_t> kinds_, is_unexplained_;  // indexed by beam
  std::vector<std::uint8_t> is_used_, is_updated_;    // indexed by cluster, indexed by entry
  std::vector<Pair> pairs_;
};

}  // namespace sidestep
