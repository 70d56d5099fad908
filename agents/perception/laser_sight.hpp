// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "agents/perception/known_floor.hpp"
#include "agents/perception/laser_tracks.hpp"
#include "agents/perception/visibility.hpp"
#include "common/config/scenario.hpp"

namespace sidestep {

struct LaserSightSettings {
  // Bounds of the errors of a scan's pose. The robot's own place is off by no more than the tracking bound.
  double position_error_m = SafetyBudget{}.tracking_bound_m;
  double heading_error_rad = 0.02;
  /// The grid takes scans at most this often: it takes most of the time, and nothing stands up as quickly.
  Duration grid_period{90'000'000};
  double unknown_cell_m = 0.2;          ///< side of the squares that report what stands but is not on the map
  double unknown_range_m = 2.5;         ///< squares farther away are ignored
  std::size_t max_unknown = 48;         ///< number of nearest squares
  Duration unknown_after{500'000'000};  ///< cells that were occupied for longer stand
};

/// What a robot makes of the scans of its own laser: where people may step out, who moves, and what stands
/// although it is not on the map. Only what the rules know to stand limits where people may be.
class LaserSight {
 public:
  /// `rules` must outlive this.
  LaserSight(const LaserSpec& laser, const FloorRules& rules, const LaserSightSettings& settings = {});

  const LaserSettings& laser() const { return beams_.settings(); }
  /// Takes a scan. `robots`: the known ones at the time of the scan. Returns false, and changes nothing, if
  /// it is not newer than the last one.
  bool update(const LaserScan& scan, std::span<const Circle> robots);

  /// Of the last scan; Time{}: none.
  Time captured_at() const { return captured_at_; }
  const LaserBeams& beams() const { return beams_; }
  const LocalGrid& grid() const { return grid_; }
  const Visibility& visibility() const { return visibility_; }
  std::span<const LaserTrack> tracks() const { return tracks_.tracks(); }
  /// Squares in which something stands that the rules do not know, the nearest ones.
  std::span<const Circle> unknown() const { return unknown_; }

 private:
  void find_unknown();

  LaserSightSettings settings_;
  double explained_within_m_;  // how far a hit on what the rules know can seem to be from it
  ObstacleWorld shapes_;
  KnownFloor floor_;
  LaserBeams beams_;
  LocalGrid grid_;
  LaserTracks tracks_;
  Visibility visibility_;
  Time captured_at_{};
  std::vector<Cell> squares_;  // working memory of find_unknown()
  std::vector<Circle> unknown_;
};

}  // namespace sidestep
