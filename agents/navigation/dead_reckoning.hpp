// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// A robot's own estimate of how accurately it is localised.
struct LocalisationUncertainty {
  double position_error_rms_m = 0;   ///< root mean square error of its position estimate
  double odometry_scale_stddev = 0;  ///< standard deviation of its odometry's relative error
};

/// How far a robot may drive without being observed before three standard deviations of its position error
/// reach `tracking_bound_m`, the largest permitted distance from its reference. 0 means that the robot has to
/// wait for an observation.
[[nodiscard]] double max_dead_reckoning_m(const LocalisationUncertainty& uncertainty,
                                          double tracking_bound_m);

}  // namespace sidestep
