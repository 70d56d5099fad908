// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/drift.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kDeviations = 3;
constexpr double kLeastScaleDeviation = 1e-6;

}  // namespace

double blind_path_m(const Localisation& known, double tracking_bound_m) {
  const double most = tracking_bound_m / kDeviations;
  const double left = most * most - known.deviation_m * known.deviation_m;
  return left > 0 ? std::sqrt(left) / std::max(known.scale_deviation, kLeastScaleDeviation) : 0;
}

}  // namespace sidestep
