// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/overhead_camera.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/frame_renderer.hpp"

namespace sidestep {

/// Uniform light, no blur and no noise, for tests of geometry.
inline RenderSpec plain_spec() {
  RenderSpec spec;
  spec.format = PixelFormat::kRgb;
  spec.far_light = 1;
  spec.blur_px = 0;
  spec.noise = 0;
  spec.surface_texture = 0;
  return spec;
}

/// A quarter of a division A field in 780 x 580 pixels, seen from 4 m above.
inline OverheadCamera quarter_field() { return {}; }

inline cv::Mat3b rgb_of(Image& image) {
  return cv::Mat3b(image.view().height_px, image.view().width_px,
                   reinterpret_cast<cv::Vec3b*>(image.pixels()));
}

inline SceneRobot random_robot(const Box& view_m, Rng& rng) {
  SceneRobot robot;
  robot.team = rng.chance(0.5) ? Team::kBlue : Team::kYellow;
  robot.pattern = static_cast<std::uint32_t>(rng.below(16));
  robot.position_m = {rng.uniform(view_m.min_m.x(), view_m.max_m.x()),
                      rng.uniform(view_m.min_m.y(), view_m.max_m.y())};
  robot.heading_rad = rng.uniform(-3.14, 3.14);
  return robot;
}

}  // namespace sidestep
