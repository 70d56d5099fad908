// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/marking/layout.hpp"
#include "vision/colours/colour_learner.hpp"
#include "vision/patterns/pose_fit.hpp"

namespace sidestep {

/// How a flat disc at a height over the floor is seen; nothing when its middle is not in the image.
std::optional<KnownDisc> seen_disc(const CameraModel& camera, Colour colour, const Vec3& centre_m,
                                   double radius_m);

/// The dots of a robot whose pose is known, those that are in the image.
std::vector<KnownDisc> seen_dots(const CameraModel& camera, const MarkingLayout& layout, Team team,
                                 const MarkingPattern& pattern, const Pose& pose, double height_m);

}  // namespace sidestep
