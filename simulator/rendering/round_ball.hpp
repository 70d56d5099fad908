// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "simulator/rendering/canvas.hpp"
#include "simulator/rendering/scene.hpp"

namespace sidestep {

inline constexpr double kBallRadius_m = RollingBall::kRadius_m;

/// Draws a camera's view of a ball over the canvas, in the same way as draw(VerticalBody).
cv::Rect draw(const SceneBall& ball, const Light& light, const CameraModel& camera, double exposure_s,
              Canvas& canvas);

}  // namespace sidestep
