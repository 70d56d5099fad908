// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/half_plane_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::half_plane_program_test {

const Circle kDisc{{0.3, -0.2}, 2};
constexpr int kGridSteps = 150;  // from the disc's centre to its edge

std::vector<HalfPlane> random_planes(std::size_t count, double max_offset, Rng& rng) {
  std::vector<HalfPlane> planes;
  while (planes.size() < count) {
    const double turn_rad = rng.uniform(0, 2 * std::numbers::pi), offset = rng.uniform(-2, max_offset);
    const Vec2 normal = rotated({1, 0}, turn_rad);
    planes.push_back({kDisc.centre_m + offset * normal, normal});
  }
  return planes;
}

/// How far a point is outside of the half-plane that it is farthest outside of; negative inside of all.
double outside(const std::vector<HalfPlane>& planes, const Vec2& point) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const HalfPlane& plane : planes) farthest = std::max(farthest, -plane.depth(point));
  return farthest;
}

template <typename Call>
void for_each_grid_point(Call call) {
  for (int x = -kGridSteps; x <= kGridSteps; ++x)
    for (int y = -kGridSteps; y <= kGridSteps; ++y)
      if (x * x + y * y <= kGridSteps * kGridSteps)
        call(Vec2(kDisc.centre_m + Vec2(x, y) * (kDisc.radius_m / kGridSteps)));
}

TEST_CASE("no point of a grid inside all half-planes is nearer to the target than the program's point") {
  int solved = 0, unsolved = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const std::size_t count = rng.below(12);
    const std::vector<HalfPlane> planes = random_planes(count, 0.8, rng);
    const double x = rng.uniform(-3, 3), y = rng.uniform(-3, 3);
    const Vec2 target(x, y);
    const std::optional<Vec2> found = nearest_inside(planes, kDisc, target);
    double nearest = std::numeric_limits<double>::infinity();
    for_each_grid_point([&](const Vec2& point) {
      if (outside(planes, point) <= 0) nearest = std::min(nearest, (point - target).norm());
    });
    if (!found) {
      CHECK(std::isinf(nearest));
      ++unsolved;
      continue;
    }
    CHECK(outside(planes, *found) < 1e-8);
    CHECK((*found - kDisc.centre_m).norm() < kDisc.radius_m + 1e-8);
    CHECK((*found - target).norm() < nearest + 1e-8);
    ++solved;
  }
  CHECK(solved > 40);
  CHECK(unsolved > 20);
}

TEST_CASE("no point of a grid inside the hard half-planes is less far outside of the soft ones") {
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const std::size_t hard_count = rng.below(4), soft_count = 3 + rng.below(9);
    const std::vector<HalfPlane> hard = random_planes(hard_count, 0.3, rng);
    const std::vector<HalfPlane> soft = random_planes(soft_count, 1.5, rng);
    const std::optional<Vec2> found = least_outside(hard, soft, kDisc);
    double least = std::numeric_limits<double>::infinity();
    for_each_grid_point([&](const Vec2& point) {
      if (outside(hard, point) <= 0) least = std::min(least, outside(soft, point));
    });
    if (!found) {
      CHECK(std::isinf(least));
      continue;
    }
    CHECK(outside(hard, *found) < 1e-8);
    CHECK((*found - kDisc.centre_m).norm() < kDisc.radius_m + 1e-8);
    CHECK(std::max(0.0, outside(soft, *found)) < std::max(0.0, least) + 1e-8);
    ++solved;
  }
  CHECK(solved > 100);
}

TEST_CASE("the order of half-planes does not change the nearest point") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<HalfPlane> planes = random_planes(8, 0.3, rng);
    const std::optional<Vec2> first = nearest_inside(planes, kDisc, {2, 1});
    rng.shuffle(planes);
    const std::optional<Vec2> second = nearest_inside(planes, kDisc, {2, 1});
    REQUIRE(first.has_value() == second.has_value());
    if (first) CHECK((*first - *second).norm() < 1e-7);
  }
}

}  // namespace sidestep::half_plane_program_test
