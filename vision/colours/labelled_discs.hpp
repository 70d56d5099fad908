// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/marking/layout.hpp"
#include "vision/colours/colour_learner.hpp"
#include "vision/patterns/pose_fit.hpp"

namespace sidestep {

/// A horizontal disc in the world, projected into the image; nullopt if its centre is outside the image.
[[nodiscard]] std::optional<LabelledDisc> projected_disc(const CameraModel& camera, Colour colour,
                                                         const Vec3& centre_m, double radius_m);

/// The dots of a robot with a known pose, projected into the image, except those outside.
[[nodiscard]] std::vector<LabelledDisc> projected_dots(const CameraModel& camera, const MarkerLayout& layout,
                                                       Team team, const MarkerPattern& pattern,
                                                       const Pose& pose, double height_m);

}  // namespace sidestep
