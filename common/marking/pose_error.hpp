// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/layout.hpp"

namespace sidestep {

/// Standard deviations of a robot's pose by least squares over all dots.
struct PoseError {
  double centroid_m = 0;  ///< of the dots' centroid, per axis
  double ahead_m = 0;     ///< of the robot's origin, along its x
  double aside_m = 0;     ///< and y
  double heading_rad = 0;
};

/// What errors of dots do to the pose, to first order, when the n dots' positions (the centre's too) have
/// independent errors of standard deviation s per axis. The fit puts the centroid at the mean of what is
/// seen, s/sqrt(n), and turns about it by the mean of the errors across, weighted with the dots' distances
/// r_i from the centroid (not from the robot's origin): s/sqrt(sum r_i²). The two are independent; the
/// origin, which lies c away from the centroid, takes |c| times the heading's error across c in addition.
PoseError predicted_pose_error(const MarkingLayout& layout, double dot_sd_m);

}  // namespace sidestep
