// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// Zones that a disc keeps out of. One that is in zones already, because they were drawn there, or because it
/// stops in them, may only come to rest where it is in none of them deeper than it is now in the deepest, or
/// nearer to its way out of all of them.
class KeepOut {
 public:
  /// The zones that a candidate from `start_m` within `reach` may enter. `way_out_m`: a place outside zones
  /// that overlap at the start. `zones` must outlive their use.
  void find(std::span<const Shape> zones, const Vec2& start_m, const std::optional<Vec2>& way_out_m,
            const Circle& reach, double radius_m);
  /// Whether the candidate, which begins at the start, enters no zone, or goes no deeper.
  [[nodiscard]] bool allows(const Trajectory& candidate) const;

 private:
  struct Nearby {
    const Shape* zone;
    double start_distance_m;  // negative inside
  };
  std::vector<Nearby> nearby_;
  double radius_m_ = 0;
  std::optional<Vec2> way_out_m_;
  double start_to_way_out_m_ = 0;
  double start_depth_m_ = 0;  // in the zone that the disc is in most deeply
};

}  // namespace sidestep
