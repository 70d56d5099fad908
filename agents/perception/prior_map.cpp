// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/prior_map.hpp"

namespace sidestep {

std::optional<Vec2> PriorMap::nearest_m(const Vec2& p, double within_m) const {
  std::optional<Vec2> nearest;
  double nearest2_m2 = within_m * within_m;
  const auto add = [&](const Vec2& point) {
    const double distance2 = (point - p).squaredNorm();
    if (distance2 > nearest2_m2) return;
    nearest2_m2 = distance2;
    nearest = point;
  };
  if (map != nullptr && map->distance_m(p, within_m) < within_m) {
    map->for_each_box(inflated({p, p}, within_m), [&](const Box& box) {
      add(p.cwiseMax(box.min_m).cwiseMin(box.max_m));
      return true;
    });
  }
  if (shapes != nullptr && shapes->touches(p, within_m)) {
    const Shape& shape = shapes->shape(shapes->nearest(p).obstacle);
    add(signed_distance(p, shape) <= 0 ? p : nearest_boundary_point(p, shape));
  }
  return nearest;
}

}  // namespace sidestep
