// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace sidestep::lens {

/// The league's radial distortion with one coefficient k (ssl-vision): a point at the distorted radius r_d
/// from the optical axis, at depth 1, has the undistorted radius r_u = r_d (1 + k r_d²). Barrel distortion
/// has k > 0 and an unbounded domain. With k < 0, r_u has a maximum at k r_d² = -1/3, beyond which the image
/// would fold over; the domain of the functions ends a little before it, where dr_u/dr_d has fallen from 1 to
/// 0.1.
inline constexpr double kMinDistortedKr2 = -0.3;      ///< lower limit of k r_d²
inline constexpr double kMinUndistortedKr2 = -0.147;  ///< lower limit of k r_u² there: -0.3 · 0.7²

/// r_u / r_d at kr2 = k r_d²; NaN outside the domain.
inline double undistortion_factor(double kr2) {
  return kr2 >= kMinDistortedKr2 ? 1 + kr2 : std::numeric_limits<double>::quiet_NaN();
}

/// r_d / r_u at kr2 = k r_u²: the root of s (1 + c s²) = 1 with c = kr2, accurate to the last bits; NaN
/// outside the domain. Newton's method from s = 1 never overshoots the root: with c > 0 the cubic is convex
/// and s decreases to it, with c < 0 it is concave and s increases to it.
inline double distortion_factor(double kr2) {
  const double c = kr2;
  if (!(c >= kMinUndistortedKr2) || !std::isfinite(c)) return std::numeric_limits<double>::quiet_NaN();
  double s = 1;
  for (int step = 0; step < 80; ++step) {
    const double cs2 = c * s * s;
    const double next = (1 + 2 * cs2 * s) / (1 + 3 * cs2);
    // The error of `next` is less than seven times the square of this step, hence below rounding errors.
    if (std::abs(next - s) <= 1e-8 * s) return next;
    s = next;
  }
  return s;
}

}  // namespace sidestep::lens
