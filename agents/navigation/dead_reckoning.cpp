// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kStandardDeviations = 3;
constexpr double kMinScaleDeviation = 1e-6;

}  // namespace

double max_dead_reckoning_m(const LocalisationUncertainty& uncertainty, double drift_bound_m) {
  const double max_deviation_m = drift_bound_m / kStandardDeviations;
  const double remaining_m2 =
      max_deviation_m * max_deviation_m - uncertainty.position_error_rms_m * uncertainty.position_error_rms_m;
  return remaining_m2 > 0
             ? std::sqrt(remaining_m2) / std::max(uncertainty.odometry_scale_stddev, kMinScaleDeviation)
             : 0;
}

}  // namespace sidestep
