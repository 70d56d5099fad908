// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// How well a robot knows where it is, by its own account.
struct Localisation {
  double deviation_m = 0;      ///< root mean square distance of its estimate from where it is
  double scale_deviation = 0;  ///< standard deviation of its odometry's relative error
};

/// How far a robot may drive on without being seen before it must fear, at three standard deviations, to be
/// farther from its reference than the bound. 0: it ought to stand and wait to be seen.
double blind_path_m(const Localisation& known, double tracking_bound_m);

}  // namespace sidestep
