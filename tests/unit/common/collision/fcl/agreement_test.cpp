// SPDX-License-Identifier: Apache-2.0
// What our worlds answer, compared with FCL.
#include <catch2/catch.hpp>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>

#include "common/collision/fcl/solid_world.hpp"
#include "common/collision/obstacle_world.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep {
namespace {

// FCL's distances between convex bodies are iterated.
constexpr double kTolerance_m = 2e-6;

Eigen::Isometry3d on_floor(const Vec2& place) {
  return Eigen::Isometry3d(Eigen::Translation3d(place.x(), place.y(), 0));
}

/// The same obstacles twice.
struct Twins {
  Twins(Rng& rng, std::size_t count, Structure structure) : world({}, structure) {
    for (const Shape& shape : random_shapes(rng, count, 2)) add(shape);
  }
  void add(const Shape& shape) {
    ids.push_back(world.add(shape));
    if (const auto* circle = std::get_if<Circle>(&shape)) {
      places.push_back(circle->centre_m);
      solid_ids.push_back(
          solids.add(std::make_shared<fcl::Sphered>(circle->radius_m), on_floor(circle->centre_m)));
    } else {
      places.push_back({0, 0});
      solid_ids.push_back(solids.add(prism(shape, 1), on_floor({0, 0})));
    }
  }
  void move(std::size_t which, const Vec2& by) {
    world.move(ids[which], by);
    places[which] += by;
    solids.move(solid_ids[which], on_floor(places[which]));
  }
  void remove(std::size_t which) {
    world.remove(ids[which]);
    solids.remove(solid_ids[which]);
    ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(which));
    solid_ids.erase(solid_ids.begin() + static_cast<std::ptrdiff_t>(which));
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(which));
  }

  ObstacleWorld world;
  SolidWorld solids;
  std::vector<ObstacleId> ids;
  std::vector<SolidWorld::Id> solid_ids;
  std::vector<Vec2> places;
};

/// A disc's way as FCL sees it: a capsule that lies on the floor.
double clearance_in_fcl(const SolidWorld& solids, const Vec2& from, const Vec2& to, double radius) {
  const Vec2 way = to - from, middle = 0.5 * (from + to);
  Eigen::Isometry3d place = on_floor(middle);
  place.rotate(
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(way.x(), way.y(), 0)));
  return solids.clearance_m(std::make_shared<fcl::Capsuled>(radius, way.norm()), place);
}

void check_queries(const Twins& twins, Rng& rng, int queries) {
  for (int i = 0; i < queries; ++i) {
    const Vec2 from = random_place(rng, 2.4), to = from + random_way(rng, 1) + Vec2(1e-3, 0);
    const double radius = rng.uniform(0.01, 0.3);
    const double in_fcl = clearance_in_fcl(twins.solids, from, to, radius);
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius, in_fcl);
    if (in_fcl > kTolerance_m) {
      CHECK_FALSE(twins.world.touches(from, to, radius));
      CHECK(twins.world.touches(from, to, radius + in_fcl + kTolerance_m));
    } else {
      CHECK(twins.world.touches(from, to, radius + kTolerance_m));
    }
    const double ball = twins.solids.clearance_m(std::make_shared<fcl::Sphered>(1e-3), on_floor(from)) + 1e-3;
    const double nearest = twins.world.nearest(from).distance_m;
    if (nearest > 1e-3 + kTolerance_m) CHECK(nearest == Approx(ball).margin(kTolerance_m));
    if (nearest <= 1e-3 - kTolerance_m) CHECK(ball <= 1e-3 + kTolerance_m);
  }
}

TEST_CASE("every structure agrees with FCL") {
  const std::uint64_t seed = GENERATE(range(1, 5));
  const Structure structure = GENERATE(Structure::kLinear, Structure::kMasks, Structure::kTree);
  const std::size_t count = GENERATE(5, 60, 200);
  CAPTURE(seed, structure, count);
  Rng rng(seed);
  Twins twins(rng, count, structure);
  check_queries(twins, rng, 60);
  for (int change = 0; change < 40; ++change) {
    const std::size_t which = rng.below(twins.ids.size());
    if (rng.chance(0.2))
      twins.add(random_shape(rng, 2, 0.2));
    else if (rng.chance(0.2) && twins.ids.size() > 1)
      twins.remove(which);
    else
      twins.move(which, random_way(rng, 1));
  }
  check_queries(twins, rng, 60);
}

TEST_CASE("a swept query from the distances of FCL agrees with exact ones") {
  const std::uint64_t seed = GENERATE(range(1, 6));
  CAPTURE(seed);
  Rng rng(seed);
  Twins twins(rng, 40, Structure::kAutomatic);
  for (int i = 0; i < 40; ++i) {
    const Vec2 from = random_place(rng, 2), to = from + random_way(rng, 1);
    const double radius = rng.uniform(0.01, 0.2);
    const auto ball = std::make_shared<fcl::Sphered>(radius);
    const auto sweep = twins.solids.sweep(ball, on_floor(from), Eigen::Vector3d(to.x(), to.y(), 0));
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius);
    if (twins.world.touches(from, to, radius - kTolerance_m)) CHECK(sweep.touches());
    if (!twins.world.touches(from, to, radius + kTolerance_m)) CHECK_FALSE(sweep.touches());
  }
}

}  // namespace
}  // namespace sidestep
