// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "agents/perception/laser_tracks.hpp"
#include "agents/perception/prior_map.hpp"
#include "agents/perception/visibility.hpp"
#include "common/config/scenario.hpp"

namespace sidestep {

struct LaserSightSettings {
  // Bounds of the errors of a scan's pose. The error of the robot's own position is at most the tracking
  // bound.
  double position_error_m = SafetyBudget{}.tracking_bound_m;
  double heading_error_rad = 0.02;
  /// Maximum number of reported squares with unknown stationary obstacles; the nearest squares are reported.
  std::size_t max_unknown = 48;
};

/// Interprets the scans of a robot's own laser: where people may step out, what moves, and which stationary
/// obstacles are not on the map. Only obstacles listed in the rules are assumed to limit where people may be.
class LaserSight {
 public:
  /// Unknown stationary obstacles are reported as squares with this side.
  static constexpr double kUnknownCell_m = 0.2;
  static constexpr Duration kUnknownAfter{500'000'000};  ///< cells occupied for longer are stationary

  /// `rules` must outlive this object.
  LaserSight(const LaserSpec& laser, const FloorRules& rules, const LaserSightSettings& settings = {});

  const LaserSettings& laser() const { return beams_.settings(); }
  /// Processes a scan. `robots` are the known robots at the time of the scan. Returns false and changes
  /// nothing if the scan is not newer than the last scan.
  bool update(const LaserScan& scan, std::span<const Circle> robots);
  /// Forgets what scans have shown, except where people may step out. The next scan replaces that, and is
  /// used whatever its time.
  void forget();

  /// Time of the last scan; Time{} if there is none.
  Time captured_at() const { return captured_at_; }
  const LaserBeams& beams() const { return beams_; }
  const LocalGrid& grid() const { return grid_; }
  const Visibility& visibility() const { return visibility_; }
  std::span<const LaserTrack> tracks() const { return tracks_.tracks(); }
  /// The nearest squares with a stationary obstacle that the rules do not contain.
  std::span<const Circle> unknown() const { return unknown_; }

 private:
  void find_unknown();

  LaserSightSettings settings_;
  double explained_within_m_;  // maximum distance of a hit from the known obstacle that explains it
  ObstacleWorld shapes_;
  PriorMap prior_map_;
  LaserBeams beams_;
  LocalGrid grid_;
  LaserTracks tracks_;
  Visibility visibility_;
  Time captured_at_{};
  std::vector<Cell> squares_;  // working memory of find_unknown()
  std::vector<Circle> unknown_;
};

}  // namespace sidestep
