// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace sidestep::lens {

/// The league's radial distortion with one coefficient k (ssl-vision): a point at the distorted radius r_d
/// from the optical axis, at depth 1, was at r_u = r_d (1 + k r_d²) before the lens. Barrel distortion has
/// k > 0 and no limit. With k < 0 r_u has a maximum, at k r_d² = -1/3, behind which the lens folds the
/// picture over: the functions' domain ends a little before it, where dr_u/dr_d has fallen from 1 to 0.1.
inline constexpr double kLeastBend = -0.3;         ///< of k r_d²
inline constexpr double kLeastSightBend = -0.147;  ///< of k r_u², at the same point: -0.3 · 0.7²

/// r_u / r_d at bend = k r_d²; not a number outside the domain.
inline double undistorting_factor(double bend) {
  return bend >= kLeastBend ? 1 + bend : std::numeric_limits<double>::quiet_NaN();
}

/// r_d / r_u at sight_bend = k r_u²: the root of s (1 + c s²) = 1, to the last bits; not a number outside the
/// domain. Newton's steps from 1 never pass the root: the cubic is convex with c > 0 and s comes down to it,
/// concave with c < 0 and s goes up.
inline double distorting_factor(double sight_bend) {
  const double c = sight_bend;
  if (!(c >= kLeastSightBend) || !std::isfinite(c)) return std::numeric_limits<double>::quiet_NaN();
  double s = 1;
  for (int step = 0; step < 80; ++step) {
    const double cube = c * s * s;
    const double next = (1 + 2 * cube * s) / (1 + 3 * cube);
    // The error is now less than seven times this step's square.
    if (std::abs(next - s) <= 1e-8 * s) return next;
    s = next;
  }
  return s;
}

}  // namespace sidestep::lens
