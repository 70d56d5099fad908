// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/camera/camera_model.hpp"

namespace sidestep {

/// The pixels of the image that may show something which stands within a radius of a place, between two
/// heights. Empty when it is outside the image or not all of it is before the camera.
cv::Rect footprint(const CameraModel& camera, const Vec2& place_m, double radius_m, double low_m,
                   double high_m);

/// A little more than half a pixel's diagonal, in metres.
double pixel_reach_m(const Eigen::Matrix2d& metres_per_pixel);

}  // namespace sidestep
