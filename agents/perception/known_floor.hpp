// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/obstacle_world.hpp"
#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// What is known to stand on the floor. Both parts are optional, and must outlive their use.
struct KnownFloor {
  const OccupancyMap* map = nullptr;
  const ObstacleWorld* shapes = nullptr;

  /// Whether something that stands is within this distance of a point.
  [[nodiscard]] bool is_near(const Vec2& p, double within_m) const {
    return (map != nullptr && map->distance_m(p, within_m) < within_m) ||
           (shapes != nullptr && shapes->touches(p, within_m));
  }
};

}  // namespace sidestep
