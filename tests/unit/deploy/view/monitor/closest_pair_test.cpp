// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/closest_pair.hpp"

#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::closest_pair_test {

TEST_CASE("the closest pair agrees with a comparison of all pairs") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  INFO("seed " << seed);
  Rng rng(seed);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<RobotPlace> robots;
    const auto count = static_cast<RobotId>(2 + rng.uniform(0, 40));
    for (RobotId id = 0; id < count; ++id) robots.push_back({id, {rng.uniform(-5, 5), rng.uniform(-1, 1)}});
    double least_m = std::numeric_limits<double>::infinity();
    for (const RobotPlace& a : robots)
      for (const RobotPlace& b : robots)
        if (a.id < b.id) least_m = std::min(least_m, (a.position_m - b.position_m).norm() - 0.2);
    const auto closest = closest_pair(robots, 0.1, {});
    REQUIRE(closest);
    CHECK(closest->clearance_m == Approx(least_m));
    CHECK(closest->first < closest->second);
    CHECK((robots[closest->first].position_m - robots[closest->second].position_m).norm() - 0.2 ==
          Approx(least_m));
  }
  CHECK_FALSE(closest_pair({{1, {0, 0}}}, 0.1, {}));
}

}  // namespace sidestep::closest_pair_test
