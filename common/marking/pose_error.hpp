// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/layout.hpp"

namespace sidestep {

/// Standard deviations of a robot's pose from a least-squares fit to all markers.
struct PoseError {
  double centroid_m = 0;      ///< error of the markers' centroid, per axis
  double longitudinal_m = 0;  ///< error of the robot's origin along its x axis
  double lateral_m = 0;       ///< error of the robot's origin along its y axis
  double heading_rad = 0;
};

/// The first-order error of a pose fit (Bruce, CMU-CS-06-181, appendix A.2.2) when the measured positions of
/// all n markers, the centre included, have independent errors with standard deviation s = marker_sd_m per
/// axis. The error of the fitted centroid is s/sqrt(n). The error of the heading is s/sqrt(sum r_i²), where
/// r_i is the distance of marker i from the centroid, not from the robot's origin. The two errors are
/// independent. The robot's origin, at an offset c from the centroid, has the additional error |c| times the
/// heading error, perpendicular to c.
PoseError predicted_pose_error(const MarkerLayout& layout, double marker_sd_m);

}  // namespace sidestep
