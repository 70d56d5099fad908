// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dead_reckoning.hpp"

#include <cmath>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::dead_reckoning_test {

TEST_CASE("after the maximum dead reckoning distance, one robot in two thousand exceeds the bound") {
  const double bound_m = 0.003;
  const LocalisationUncertainty known{0.0006, 0.002};
  const double path_m = max_dead_reckoning_m(known, bound_m);
  Rng rng(5);
  CAPTURE(path_m);
  int beyond = 0;
  constexpr int kRobots = 100'000;
  for (int i = 0; i < kRobots; ++i) {
    const double fix_error_m = known.position_error_rms_m * rng.normal();
    const double odometry_error_m = known.odometry_scale_stddev * rng.normal() * path_m;
    beyond += std::abs(fix_error_m + odometry_error_m) > bound_m;
  }
  CHECK(beyond > kRobots / 4000);
  CHECK(beyond < kRobots / 1500);
}

TEST_CASE(
    "the permitted dead reckoning distance is long for accurate odometry and zero for a poor position") {
  CHECK(max_dead_reckoning_m({0, 0.005}, 0.003) == Approx(0.15));
  CHECK(max_dead_reckoning_m({0.0002, 0}, 0.003) > 100);
  CHECK(max_dead_reckoning_m({0.001, 0.001}, 0.003) == 0);
  CHECK(max_dead_reckoning_m({0.01, 0}, 0.003) == 0);
}

}  // namespace sidestep::dead_reckoning_test
