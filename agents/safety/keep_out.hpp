// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// Zones that a disc must keep out of. A disc may already be in zones, because they were drawn there or
/// because it stops in them. It may then come to rest only where it is no deeper in any zone than it now is
/// in its deepest zone, or where it is nearer to its way out of all zones.
class KeepOut {
 public:
  /// Finds the zones that a candidate from `start_m` within `reach` may enter. `way_out_m` is a place outside
  /// all zones, if zones overlap at the start. `zones` must outlive their use.
  void find(std::span<const Shape> zones, const Vec2& start_m, const std::optional<Vec2>& way_out_m,
            const Circle& reach, double radius_m);
  /// Whether the candidate enters no zone, and comes to rest no deeper than allowed in zones that it starts
  /// in.
  [[nodiscard]] bool allows(const Trajectory& candidate) const;

 private:
  struct NearbyZone {
    const Shape* zone;
    double start_distance_m;  // negative inside
  };
  std::vector<NearbyZone> nearby_;
  double radius_m_ = 0;
  std::optional<Vec2> way_out_m_;
  double start_to_way_out_m_ = 0;
  double start_depth_m_ = 0;  // depth in the zone that the disc is deepest in
};

}  // namespace sidestep
