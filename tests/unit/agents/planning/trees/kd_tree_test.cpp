// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/trees/kd_tree.hpp"

#include "agents/planning/trees/linear_nearest.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::kd_tree_test {

/// Samples points as planners store them: uniform, in clusters, on lines, or repeated.
template <std::size_t N>
std::array<double, N> sample_point(std::uint64_t kind, Rng& rng) {
  std::array<double, N> point{};
  const double cluster = kind == 1 ? static_cast<double>(rng.below(3)) : 0;
  for (double& x : point) x = kind == 1 ? cluster + 0.01 * rng.normal() : rng.uniform(-5, 5);
  if (kind == 2) point[0] = 1;
  if (kind == 3) {
    for (double& x : point) x = std::floor(x);
  }
  return point;
}

template <std::size_t N>
void compare(std::uint64_t seed) {
  CAPTURE(N, seed);
  Rng rng(seed);
  KdTree<N> tree;
  LinearNearest<N> reference;
  for (int round = 0; round < 2; ++round) {
    tree.clear();
    reference.clear();
    for (int i = 0; i < 1500; ++i) {
      const auto point = sample_point<N>(seed % 4, rng);
      tree.add(point);
      reference.add(point);
      REQUIRE(tree.size() == static_cast<std::size_t>(i + 1));
      const auto query = sample_point<N>(rng.below(4), rng);
      REQUIRE(tree.nearest(query) == reference.nearest(query));
      REQUIRE(tree.nearest(point) == reference.nearest(point));
    }
  }
}

TEST_CASE("the K-D tree finds the same neighbour as a linear search") {
  const auto seed = GENERATE(range<std::uint64_t>(0, 8));
  compare<2>(seed);
  compare<3>(seed);
  compare<6>(seed);
}

}  // namespace sidestep::kd_tree_test
