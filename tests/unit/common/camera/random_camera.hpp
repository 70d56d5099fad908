// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/overhead_camera.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A camera above a random part of the floor, tilted by up to about 30 degrees, with or without barrel
/// distortion.
inline OverheadCamera random_overhead_camera(Rng& rng) {
  OverheadCamera camera;
  const double y = rng.uniform(-4, 4), x = rng.uniform(-5, 5);
  const double half_y = rng.uniform(0.5, 3), half_x = rng.uniform(0.5, 3.5);
  const Vec2 centre(x, y), half(half_x, half_y);
  camera.view_m = {centre - half, centre + half};
  camera.height_m = rng.uniform(2.5, 6);
  const double offset_y = rng.uniform(-2, 2), offset_x = rng.uniform(-2, 2);
  camera.lateral_offset_m = Vec2(offset_x, offset_y);
  camera.distortion = rng.chance(0.2) ? 0 : rng.uniform(0, 0.4);
  if (rng.chance(0.3)) camera.width_px = 2448, camera.height_px = 2048;
  return camera;
}

inline Vec2 random_point_in(const Box& box, Rng& rng) {
  return {rng.uniform(box.min_m.x(), box.max_m.x()), rng.uniform(box.min_m.y(), box.max_m.y())};
}

}  // namespace sidestep
