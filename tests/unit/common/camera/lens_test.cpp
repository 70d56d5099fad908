// SPDX-License-Identifier: Apache-2.0
#include "common/camera/lens.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::lens_test {

/// The root of s (1 + c s²) = 1 by bisection, on the branch that begins at s = 1 for c = 0.
double reference_factor(double c) {
  long double low = c >= 0 ? 0 : 1, high = c >= 0 ? 1 : 1 / std::sqrt(-3.0L * c);
  for (int i = 0; i < 200; ++i) {
    const long double middle = (low + high) / 2;
    (middle * (1 + c * middle * middle) < 1 ? low : high) = middle;
  }
  return static_cast<double>(low);
}

TEST_CASE("inverting the distortion is accurate to the last bits") {
  const std::uint64_t seed = 17;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 20000; ++i) {
    const bool is_barrel = rng.chance(0.7);
    const double c =
        is_barrel ? std::exp(rng.uniform(std::log(1e-9), std::log(1e6))) : rng.uniform(-0.147, 0);
    CAPTURE(c);
    const double s = lens::distortion_factor(c);
    REQUIRE(s == Approx(reference_factor(c)).epsilon(1e-13).margin(0));
    // Round trip: k r_u² -> k r_d² -> factor.
    REQUIRE(lens::undistortion_factor(c * s * s) * s == Approx(1).epsilon(1e-13).margin(0));
  }
  CHECK(lens::distortion_factor(0) == 1);
}

TEST_CASE("the distortion factors are NaN outside the domain of the lens") {
  CHECK(std::isnan(lens::distortion_factor(-0.1471)));
  CHECK(std::isnan(lens::distortion_factor(-4.0 / 27)));
  CHECK(std::isnan(lens::distortion_factor(INFINITY)));
  CHECK(std::isnan(lens::distortion_factor(NAN)));
  CHECK(std::isnan(lens::undistortion_factor(-0.3001)));
  CHECK(std::isnan(lens::undistortion_factor(NAN)));
  // The limits of both factors belong to the same point, where dr_u/dr_d is 0.1.
  const double s = lens::distortion_factor(lens::kMinUndistortedKr2);
  CHECK(s * s * lens::kMinUndistortedKr2 == Approx(lens::kMinDistortedKr2));
  CHECK(1 + 3 * lens::kMinDistortedKr2 == Approx(0.1));
}

}  // namespace sidestep::lens_test
