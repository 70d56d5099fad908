// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/collision/obstacle_world.hpp"
#include "common/map/distance_field.hpp"

namespace sidestep {

/// The objects that rays can hit. All parts are optional. `field` is the distance field of `map`, and is
/// required if there is a map.
struct RayScene {
  const OccupancyMap* map = nullptr;
  const DistanceField* field = nullptr;
  const ObstacleWorld* shapes = nullptr;
  std::span<const Circle> discs{};  ///< robots and people
};

/// The distance from a point along a unit vector to the first blocked cell or the outside: 0 if the point is
/// blocked or outside, infinite if the distance exceeds `max_m`. The distance field serves to skip cells far
/// from blocked ones; others are traversed one by one (Amanatides and Woo 1987). A ray within a nanometre of
/// a corner or an edge may hit it or not. Throws std::invalid_argument for non-finite numbers.
[[nodiscard]] double cast_ray(const OccupancyMap& map, const DistanceField& field, const Vec2& from_m,
                              const Vec2& direction, double max_m);

/// The distance along a ray to the first object in a scene. The conventions of the overload above apply.
[[nodiscard]] double cast_ray(const RayScene& scene, const Vec2& from_m, const Vec2& direction, double max_m);

}  // namespace sidestep
