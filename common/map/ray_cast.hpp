// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/collision/obstacle_world.hpp"
#include "common/map/distance_field.hpp"

namespace sidestep {

/// What rays can hit. All parts are optional. `field` is the distance field of `map`, and is required if
/// there is a map.
struct RayScene {
  const OccupancyMap* map = nullptr;
  const DistanceField* field = nullptr;
  const ObstacleWorld* shapes = nullptr;
  std::span<const Circle> discs{};  ///< robots and people
};

/// The distance from a point along a unit vector to the first blocked cell or the outside: 0 if the point is
/// in either, infinite if it exceeds `max_m`. Cells far from blocked ones are skipped by the distance field,
/// others are traversed one by one (Amanatides and Woo 1987). A ray that passes a corner or an edge within a
/// nanometre may hit it or not. Throws std::invalid_argument for numbers that are not finite.
[[nodiscard]] double cast_ray(const OccupancyMap& map, const DistanceField& field, const Vec2& from_m,
                              const Vec2& direction, double max_m);

/// The distance along a ray to the first hit of anything in a scene; same conventions as above.
[[nodiscard]] double cast_ray(const RayScene& scene, const Vec2& from_m, const Vec2& direction, double max_m);

}  // namespace sidestep
