// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "simulator/rendering/canvas.hpp"
#include "simulator/rendering/scene.hpp"

namespace sidestep {

/// Of the league's ball.
inline constexpr double kBallRadius_m = 0.0215;

/// Draws what the camera sees of a ball over what is there, as draw() of upright bodies does.
cv::Rect draw(const SceneBall& ball, const Light& light, const CameraModel& camera, double exposure_s,
              Canvas& canvas);

}  // namespace sidestep
