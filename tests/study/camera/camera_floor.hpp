// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/frame_renderer.hpp"

namespace sidestep {

inline constexpr Field kGuidedField{5.4, 4.0};
inline constexpr double kGuidedRadius_m = 0.09;

/// A floor with coloured obstacles, a robot's start and a target.
struct CameraFloor {
  std::vector<SceneCylinder> cylinders;
  StaticScene statics;
  Vec2 start_m{0, 0}, target_m{0, 0};

  /// The distance from a point to the nearest obstacle.
  double clearance_m(const Vec2& p) const;
};

/// Samples four to nine obstacles (cylinders and blocks) with space around start and target.
[[nodiscard]] CameraFloor sample_camera_floor(Rng& rng);
/// A random place on the field that keeps this distance from obstacles.
[[nodiscard]] Vec2 sample_free_place(const CameraFloor& floor, double clearance_m, Rng& rng);

/// The camera that guides the robot. It is 4 m above the field and shows the whole field in 800 x 600 pixels.
[[nodiscard]] CameraModel guiding_camera();
/// The same camera, rotated about a random axis through it.
[[nodiscard]] CameraModel bumped(const CameraModel& camera, double angle_rad, Rng& rng);

}  // namespace sidestep
