// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/camera/camera_model.hpp"

namespace sidestep {

/// The pixels that may show an object that lies within a radius of a place and between two heights. Empty if
/// the object is outside the image or not entirely in front of the camera.
cv::Rect footprint(const CameraModel& camera, const Vec2& place_m, double radius_m, double low_m,
                   double high_m);

/// Slightly more than half a pixel's diagonal, in metres.
double pixel_reach_m(const Eigen::Matrix2d& metres_per_pixel);

}  // namespace sidestep
