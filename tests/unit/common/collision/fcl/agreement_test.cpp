// SPDX-License-Identifier: Apache-2.0
// Compares the answers of ObstacleWorld with FCL.
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>

#include "common/collision/obstacle_world.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/collision/fcl/solid_world.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep::agreement_test {

// FCL computes distances between convex bodies iteratively.
constexpr double kTolerance_m = 2e-6;

Eigen::Isometry3d on_floor(const Vec2& pose) {
  return Eigen::Isometry3d(Eigen::Translation3d(pose.x(), pose.y(), 0));
}

/// The same obstacles in an ObstacleWorld and in FCL.
struct WorldPair {
  WorldPair(Rng& rng, std::size_t count, Structure structure) : world({}, structure) {
    for (const Shape& shape : random_shapes(rng, count, 2)) add(shape);
  }
  void add(const Shape& shape) {
    ids.push_back(world.add(shape));
    if (const auto* circle = std::get_if<Circle>(&shape)) {
      positions.push_back(circle->centre_m);
      solid_ids.push_back(
          solids.add(std::make_shared<fcl::Sphered>(circle->radius_m), on_floor(circle->centre_m)));
    } else {
      positions.push_back({0, 0});
      solid_ids.push_back(solids.add(prism(shape, 1), on_floor({0, 0})));
    }
  }
  void move(std::size_t which, const Vec2& by) {
    world.move(ids[which], by);
    positions[which] += by;
    solids.move(solid_ids[which], on_floor(positions[which]));
  }
  void remove(std::size_t which) {
    world.remove(ids[which]);
    solids.remove(solid_ids[which]);
    ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(which));
    solid_ids.erase(solid_ids.begin() + static_cast<std::ptrdiff_t>(which));
    positions.erase(positions.begin() + static_cast<std::ptrdiff_t>(which));
  }

  ObstacleWorld world;
  SolidWorld solids;
  std::vector<ObstacleId> ids;
  std::vector<SolidWorld::Id> solid_ids;
  std::vector<Vec2> positions;
};

/// The clearance of a swept disc according to FCL, computed for a capsule lying on the floor.
double clearance_in_fcl(const SolidWorld& solids, const Vec2& from, const Vec2& to, double radius) {
  const Vec2 displacement = to - from, middle = 0.5 * (from + to);
  Eigen::Isometry3d pose = on_floor(middle);
  pose.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(0, 0, 1),
                                                 Eigen::Vector3d(displacement.x(), displacement.y(), 0)));
  return solids.clearance_m(std::make_shared<fcl::Capsuled>(radius, displacement.norm()), pose);
}

void check_queries(const WorldPair& pair, Rng& rng, int queries) {
  for (int i = 0; i < queries; ++i) {
    const Vec2 from = random_position(rng, 2.4), to = from + random_displacement(rng, 1) + Vec2(1e-3, 0);
    const double radius = rng.uniform(0.01, 0.3);
    const double in_fcl = clearance_in_fcl(pair.solids, from, to, radius);
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius, in_fcl);
    if (in_fcl > kTolerance_m) {
      CHECK_FALSE(pair.world.touches(from, to, radius));
      CHECK(pair.world.touches(from, to, radius + in_fcl + kTolerance_m));
    } else {
      CHECK(pair.world.touches(from, to, radius + kTolerance_m));
    }
    const double fcl_distance_m =
        pair.solids.clearance_m(std::make_shared<fcl::Sphered>(1e-3), on_floor(from)) + 1e-3;
    const double nearest = pair.world.nearest(from).distance_m;
    if (nearest > 1e-3 + kTolerance_m) CHECK(nearest == Approx(fcl_distance_m).margin(kTolerance_m));
    if (nearest <= 1e-3 - kTolerance_m) CHECK(fcl_distance_m <= 1e-3 + kTolerance_m);
  }
}

TEST_CASE("every collision structure agrees with FCL") {
  const std::uint64_t seed = GENERATE(range(1, 5));
  const Structure structure = GENERATE(Structure::kLinear, Structure::kMasks, Structure::kTree);
  const std::size_t count = GENERATE(5, 60, 200);
  CAPTURE(seed, structure, count);
  Rng rng(seed);
  WorldPair pair(rng, count, structure);
  check_queries(pair, rng, 60);
  for (int change = 0; change < 40; ++change) {
    const std::size_t which = rng.below(pair.ids.size());
    if (rng.chance(0.2))
      pair.add(random_shape(rng, 2, 0.2));
    else if (rng.chance(0.2) && pair.ids.size() > 1)
      pair.remove(which);
    else
      pair.move(which, random_displacement(rng, 1));
  }
  check_queries(pair, rng, 60);
}

TEST_CASE("sweeps based on FCL's distances agree with exact sweeps") {
  const std::uint64_t seed = GENERATE(range(1, 6));
  CAPTURE(seed);
  Rng rng(seed);
  WorldPair pair(rng, 40, Structure::kAutomatic);
  for (int i = 0; i < 40; ++i) {
    const Vec2 from = random_position(rng, 2), to = from + random_displacement(rng, 1);
    const double radius = rng.uniform(0.01, 0.2);
    const auto ball = std::make_shared<fcl::Sphered>(radius);
    const auto sweep = pair.solids.sweep(ball, on_floor(from), Eigen::Vector3d(to.x(), to.y(), 0));
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius);
    if (pair.world.touches(from, to, radius - kTolerance_m)) CHECK(sweep.touches());
    if (!pair.world.touches(from, to, radius + kTolerance_m)) CHECK_FALSE(sweep.touches());
  }
}

}  // namespace sidestep::agreement_test
