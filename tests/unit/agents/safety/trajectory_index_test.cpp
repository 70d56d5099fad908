// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/trajectory_index.hpp"

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::trajectory_index_test {

TEST_CASE("an index finds exactly the versions whose discs touch a circle, for any number and density") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(kernels.name);
    TrajectoryIndex index(kernels);
    for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 63u, 64u, 65u, 300u, 2000u}) {
      CAPTURE(count);
      const double half_side = rng.chance(0.5) ? 0.5 : rng.uniform(1, 200);
      std::vector<Version> versions;
      for (std::size_t i = 0; i < count; ++i) {
        Version version;
        version.robot = static_cast<RobotId>(i);
        version.trajectory = Trajectory({}, {random_vector(rng, half_side), random_vector(rng, 2)});
        append_stop(version.trajectory, 5);
        if (rng.chance(0.01)) version.inflation_m = rng.uniform(0, 0.5);
        versions.push_back(version);
      }
      index.assign(versions);
      for (int i = 0; i < 50; ++i) {
        const Circle circle{random_vector(rng, 1.5 * half_side), rng.uniform(0, 1)};
        std::vector<std::uint32_t> expected, found;
        for (std::uint32_t k = 0; k < count; ++k) {
          const double max_distance = circle.radius_m + index.bounds(k).disc.radius_m;
          if ((circle.centre_m - index.bounds(k).disc.centre_m).squaredNorm() <= max_distance * max_distance)
            expected.push_back(k);
        }
        index.find(circle, found);
        std::ranges::sort(found);
        REQUIRE(found == expected);
      }
    }
  }
}

TEST_CASE("the bounding disc of an indexed version includes its inflation") {
  TrajectoryIndex index;
  Version version{1, 1, 1, 0, Trajectory::resting({}, {0, 0}), 0.25};
  index.add(version);
  CHECK(index.bounds(0).disc.radius_m == Approx(0.25).margin(1e-5));
  index.clear();
  std::vector<std::uint32_t> found;
  index.find({{0, 0}, 10}, found);
  CHECK(found.empty());
}

}  // namespace sidestep::trajectory_index_test
