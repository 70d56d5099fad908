// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

// Numbers of standard deviations used. Among hundreds of robots, one may have odometry that is three standard
// deviations off, and it stays so until its filter has learned the error.
constexpr double kFixDeviations = 3, kScaleDeviations = 4;
constexpr double kMinScaleDeviation = 1e-6;

}  // namespace

double max_dead_reckoning_m(const LocalisationUncertainty& uncertainty, double drift_bound_m) {
  const double fix_m = kFixDeviations * uncertainty.position_error_rms_m;
  const double remaining_m2 = drift_bound_m * drift_bound_m - fix_m * fix_m;
  const double scale = kScaleDeviations * std::max(uncertainty.odometry_scale_stddev, kMinScaleDeviation);
  return remaining_m2 > 0 ? std::sqrt(remaining_m2) / scale : 0;
}

}  // namespace sidestep
