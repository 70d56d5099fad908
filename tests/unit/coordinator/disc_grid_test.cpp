// SPDX-License-Identifier: Apache-2.0
#include "coordinator/disc_grid.hpp"

#include <optional>

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::disc_grid_test {

TEST_CASE("while discs are moved, added and removed, a grid finds exactly the discs that touch a circle") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  CAPTURE(seed);
  Rng rng(seed);
  constexpr std::uint32_t kDiscs = 300;
  const Field field{rng.uniform(1, 300), rng.uniform(1, 300)};
  const double range = 0.6 * std::max(field.length_m, field.width_m);
  DiscGrid grid(field, kDiscs);
  std::vector<std::optional<Circle>> discs(kDiscs);
  std::vector<std::uint32_t> found;
  for (int step = 0; step < 20'000; ++step) {
    const auto disc = static_cast<std::uint32_t>(rng.below(kDiscs));
    if (rng.chance(0.1)) {
      grid.remove(disc);
      discs[disc].reset();
    } else {
      const double radius = rng.chance(0.02)  ? 1e300
                            : rng.chance(0.1) ? rng.uniform(0, 20)
                                              : rng.uniform(0, 1);
      const Vec2 nearby =
          discs[disc] ? Vec2(discs[disc]->centre_m + random_vector(rng, 0.2)) : random_vector(rng, range);
      discs[disc] = Circle{rng.chance(0.5) ? nearby : random_vector(rng, range), radius};
      grid.set(disc, *discs[disc]);
    }
    const Circle circle{random_vector(rng, range), rng.uniform(0, rng.chance(0.1) ? range : 2)};
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < kDiscs; ++i) {
      if (!discs[i]) continue;
      const double far = circle.radius_m + discs[i]->radius_m;
      if ((circle.centre_m - discs[i]->centre_m).squaredNorm() <= far * far) expected.push_back(i);
    }
    grid.find(circle, found);
    REQUIRE(found == expected);
  }
}

}  // namespace sidestep::disc_grid_test
