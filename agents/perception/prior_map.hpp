// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/collision/obstacle_world.hpp"
#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// Everything on the floor that is known to be stationary. All parts are optional, and must outlive their
/// use.
struct PriorMap {
  const OccupancyMap* map = nullptr;
  const ObstacleWorld* shapes = nullptr;

  /// Whether anything stationary is within this distance of a point.
  [[nodiscard]] bool is_near(const Vec2& p, double within_m) const {
    return (map != nullptr && map->distance_m(p, within_m) < within_m) ||
           (shapes != nullptr && shapes->touches(p, within_m));
  }
  /// The nearest point of anything stationary, or the point itself if it is inside; nullopt if everything is
  /// farther than `within_m`.
  [[nodiscard]] std::optional<Vec2> nearest_m(const Vec2& p, double within_m) const;
};

}  // namespace sidestep
