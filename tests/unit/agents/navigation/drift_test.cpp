// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/drift.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/random/rng.hpp"

using namespace sidestep;

TEST_CASE("after the way that a robot may drive blindly one in 370 is beyond the bound, not more") {
  const double bound_m = 0.003;
  const Localisation known{0.0006, 0.002};
  const double path_m = blind_path_m(known, bound_m);
  Rng rng(5);
  CAPTURE(path_m);
  int beyond = 0;
  constexpr int kRobots = 100'000;
  for (int i = 0; i < kRobots; ++i) {
    const double error_m = known.deviation_m * rng.normal() + known.scale_deviation * rng.normal() * path_m;
    beyond += std::abs(error_m) > bound_m;
  }
  CHECK(beyond > kRobots / 500);
  CHECK(beyond < kRobots / 300);
}

TEST_CASE("who knows its wheels drives far, and who does not know where it is stands") {
  CHECK(blind_path_m({0, 0.005}, 0.003) == Approx(0.2));
  CHECK(blind_path_m({0.0002, 0}, 0.003) > 100);
  CHECK(blind_path_m({0.001, 0.001}, 0.003) == 0);
  CHECK(blind_path_m({0.01, 0}, 0.003) == 0);
}
