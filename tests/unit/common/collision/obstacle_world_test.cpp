// SPDX-License-Identifier: Apache-2.0
#include "common/collision/obstacle_world.hpp"

#include "common/collision/batch/dispatch.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep::obstacle_world_test {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTolerance_m = 1e-9;
constexpr Structure kStructures[] = {Structure::kAutomatic, Structure::kLinear, Structure::kMasks,
                                     Structure::kTree};

/// The distance from a path to the nearest shape, by brute force, independent of the structures under test.
double exact_distance(const ObstacleWorld& world, const Vec2& from, const Vec2& to) {
  double nearest2 = kInfinite;
  for (const ObstacleId id : world.obstacles())
    nearest2 = std::min(nearest2, squared_distance(Segment{from, to}, world.shape(id)));
  return std::sqrt(nearest2);
}

/// Checks that the first contact touches its obstacle, and that the path before it is free.
void check_first_contact(const ObstacleWorld& world, const Vec2& from, const Vec2& to, double radius,
                         double distance) {
  const std::optional<Contact> contact = world.first_contact(from, to, radius);
  if (std::abs(distance - radius) > kTolerance_m) CHECK(contact.has_value() == (distance < radius));
  if (!contact) return;
  CHECK((contact->fraction >= 0 && contact->fraction <= 1));
  const Vec2 at = from + contact->fraction * (to - from);
  CHECK(signed_distance(at, world.shape(contact->obstacle)) <= radius + kTolerance_m);
  if (contact->fraction > 0) CHECK(exact_distance(world, from, at) >= radius - kTolerance_m);
}

void check_queries(const ObstacleWorld& world, Rng& rng, double half_m, double max_length_m, int queries) {
  for (int i = 0; i < queries; ++i) {
    const Vec2 from = random_position(rng, 1.2 * half_m);
    const Vec2 to = rng.chance(0.1) ? from : from + random_displacement(rng, max_length_m);
    const double distance = exact_distance(world, from, to);
    // Many radii are close to the distance, where the answer changes.
    double radius = rng.chance(0.1) ? 0 : rng.uniform(0, 0.2 * half_m);
    if (rng.chance(0.5) && distance < half_m) radius = std::max(0.0, distance + rng.uniform(-1e-6, 1e-6));
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius, distance);
    if (std::abs(distance - radius) > kTolerance_m)
      CHECK(world.touches(from, to, radius) == (distance < radius));
    check_first_contact(world, from, to, radius, distance);
    const Nearest nearest = world.nearest(from);
    double signed_m = kInfinite;
    for (const ObstacleId id : world.obstacles())
      signed_m = std::min(signed_m, signed_distance(from, world.shape(id)));
    CHECK(nearest.distance_m == Approx(signed_m).margin(1e-12));
    CHECK(signed_distance(from, world.shape(nearest.obstacle)) == nearest.distance_m);
    if (std::abs(signed_m - radius) > kTolerance_m) CHECK(world.touches(from, radius) == (signed_m < radius));
  }
}

TEST_CASE("an obstacle world's answers agree with the exact distances to its shapes") {
  const std::size_t count = GENERATE(1, 2, 15, 16, 17, 64, 65, 300, 1500);
  const std::uint64_t seed = GENERATE(1, 2, 3);
  for (const Structure structure : kStructures) {
    for (const collision::Kernels& kernels : collision::available_kernels()) {
      CAPTURE(count, seed, structure, kernels.name);
      Rng rng(seed);
      const ObstacleWorld world(random_shapes(rng, count, 5), structure, kernels);
      check_queries(world, rng, 5, 10 / std::sqrt(static_cast<double>(count)), count < 1000 ? 200 : 50);
    }
  }
}

TEST_CASE("the answers for a world of circles agree with the exact distances") {
  const std::size_t count = GENERATE(3, 16, 64, 100, 1100);
  const std::uint64_t seed = GENERATE(1, 2, 3);
  for (const Structure structure : kStructures) {
    for (const collision::Kernels& kernels : collision::available_kernels()) {
      CAPTURE(count, seed, structure, kernels.name);
      Rng rng(seed);
      std::vector<Shape> circles;
      for (std::size_t i = 0; i < count; ++i)
        circles.push_back(
            Circle{random_position(rng, 5), rng.uniform(0, 3 / std::sqrt(static_cast<double>(count)))});
      const ObstacleWorld world(circles, structure, kernels);
      check_queries(world, rng, 5, 10 / std::sqrt(static_cast<double>(count)), count < 1000 ? 300 : 50);
    }
  }
}

TEST_CASE("queries with integer coordinates are answered correctly") {
  const std::uint64_t seed = GENERATE(range(1, 8));
  Rng rng(seed);
  const auto integer_position = [&] {
    const auto y = static_cast<double>(rng.below(9)), x = static_cast<double>(rng.below(9));
    return Vec2(x - 4, y - 4);
  };
  // Some shapes degenerate to points or lines, or are collinear with a path.
  std::vector<Shape> shapes;
  for (int i = 0; i < 12; ++i) {
    const Vec2 a = integer_position(), b = integer_position();
    shapes.push_back(Segment{a, rng.chance(0.2) ? a : b});
    shapes.push_back(Box{a.cwiseMin(b), a.cwiseMax(b).cwiseMin(a.cwiseMin(b) + Vec2(1, 1))});
    shapes.push_back(ConvexPolygon{{b, b + Vec2(1, 0), b + Vec2(2, 0), b + Vec2(2, 1), b + Vec2(1, 1.5)}});
    shapes.push_back(Circle{b, rng.chance(0.5) ? 0 : 0.5});
    const std::size_t first = rng.below(shapes.size());
    shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(first));
  }
  for (const Structure structure : kStructures) {
    for (const collision::Kernels& kernels : collision::available_kernels()) {
      CAPTURE(seed, structure, kernels.name);
      std::size_t next = 1;
      for (const Shape& shape : shapes) {
        // Two shapes per world: with more, nearly every path would touch.
        const ObstacleWorld world({shape, shapes[next++ % shapes.size()]}, structure, kernels);
        for (int i = 0; i < 60; ++i) {
          const Vec2 from = integer_position(), to = integer_position();
          const double radius = 0.5 * static_cast<double>(rng.below(3)),
                       distance = exact_distance(world, from, to);
          CAPTURE(from.x(), from.y(), to.x(), to.y(), radius, distance);
          if (distance > radius + kTolerance_m) CHECK_FALSE(world.touches(from, to, radius));
          if (distance < radius + kTolerance_m) CHECK(world.touches(from, to, radius + 2 * kTolerance_m));
        }
      }
    }
  }
}

TEST_CASE("a world far from the origin answers accurately") {
  const Structure structure = kStructures[GENERATE(range(0, 4))];
  CAPTURE(structure);
  Rng rng(3);
  std::vector<Shape> shapes = random_shapes(rng, 40, 5);
  for (Shape& shape : shapes) shape = moved(shape, {4e5, -3e5});
  const ObstacleWorld world(shapes, structure);
  for (int i = 0; i < 300; ++i) {
    const Vec2 from = Vec2(4e5, -3e5) + random_position(rng, 6), to = from + random_displacement(rng, 2);
    const double distance = exact_distance(world, from, to);
    CHECK(world.touches(from, to, distance + 1e-8));
    if (distance > 1e-8) CHECK_FALSE(world.touches(from, to, distance - 1e-8));
  }
}

TEST_CASE("sweeping a disc finds contact anywhere along its path") {
  const std::uint64_t seed = GENERATE(range(1, 8));
  const Structure structure = kStructures[GENERATE(range(0, 4))];
  CAPTURE(seed, structure);
  Rng rng(seed);
  const ObstacleWorld world(random_shapes(rng, 30, 1), structure);
  for (int i = 0; i < 50; ++i) {
    const Vec2 from = random_position(rng, 1), to = from + random_displacement(rng, 0.5);
    const double radius = rng.uniform(0, 0.1);
    double sampled = kInfinite;
    for (const ObstacleId id : world.obstacles())
      sampled = std::min(sampled, sampled_distance(from, to, world.shape(id), 250));
    if (sampled <= radius - kTolerance_m) CHECK(world.touches(from, to, radius));
    if (sampled > radius + 1e-3 + kTolerance_m) CHECK_FALSE(world.touches(from, to, radius));
  }
}

TEST_CASE("a world stays correct as obstacles are added, moved and removed") {
  const std::uint64_t seed = GENERATE(range(1, 4));
  const Structure structure = kStructures[GENERATE(range(0, 4))];
  const std::size_t count = GENERATE(0, 20, 400);
  CAPTURE(seed, structure, count);
  Rng rng(seed);
  ObstacleWorld world(random_shapes(rng, count, 2), structure);
  // At first more obstacles are added than removed, later more are removed.
  for (int round = 0; round < 60; ++round) {
    const double add_probability = round < 30 ? 0.3 : 0.05;
    for (int change = 0; change < 15; ++change) {
      const std::vector<ObstacleId> ids = world.obstacles();
      const ObstacleId any = ids.empty() ? kNoObstacle : ids[rng.below(ids.size())];
      const double choice = rng.uniform();
      if (choice < add_probability || ids.empty())
        world.add(random_shape(rng, 2, 0.3));
      else if (choice < 0.5)
        world.remove(any);
      else
        world.move(any, random_displacement(rng, rng.chance(0.1) ? 30 : 0.5));
    }
    if (world.size() > 0) check_queries(world, rng, 2, 1, 20);
  }
}

TEST_CASE("an obstacle keeps its id while other obstacles are added and removed") {
  ObstacleWorld world({Circle{{0, 0}, 1}, Box{{4, 0}, {5, 1}}, Circle{{9, 0}, 1}});
  const ObstacleId third{2};
  world.remove(ObstacleId{0});
  const ObstacleId wall = world.add(Segment{{0, 5}, {9, 5}});
  CHECK(std::get<Circle>(world.shape(third)).centre_m == Vec2(9, 0));
  world.move(third, {0, 2});
  CHECK(world.nearest({9, 2}).obstacle == third);
  CHECK(world.nearest({4, 4.5}).obstacle == wall);
  CHECK_FALSE(world.touches({0, 0}, 1));
  CHECK(world.size() == 3);
}

TEST_CASE("nothing touches in an empty world") {
  const Structure structure = kStructures[GENERATE(range(0, 4))];
  CAPTURE(structure);
  ObstacleWorld world({}, structure);
  CHECK_FALSE(world.touches({0, 0}, {1, 1}, 100));
  CHECK(world.nearest({0, 0}).obstacle == kNoObstacle);
  CHECK(world.nearest({0, 0}).distance_m == kInfinite);
  const ObstacleId only = world.add(Circle{{0, 0}, 1});
  CHECK(world.touches({0.5, 0}, 0));
  world.remove(only);
  CHECK_FALSE(world.touches({0.5, 0}, 0));
}

TEST_CASE("shapes that share a single point touch") {
  const Structure structure = kStructures[GENERATE(range(0, 4))];
  CAPTURE(structure);
  const ObstacleWorld world({Circle{{0, 0}, 1}, Box{{4, 0}, {5, 1}}}, structure);
  CHECK(world.touches({2, 0}, 1));
  CHECK(world.touches({-2, 1}, {2, 1}, 0));
  CHECK(world.touches({3, 0.5}, 1));
}

TEST_CASE("a world rejects invalid shapes, queries and ids") {
  CHECK_THROWS_WITH(ObstacleWorld({Circle{{0, 0}, 1}, Circle{{0, 0}, -1}}),
                    "obstacle 1: a circle's radius is negative");
  const Structure structure = kStructures[GENERATE(range(0, 4))];
  CAPTURE(structure);
  ObstacleWorld world({Circle{{0, 0}, 1}}, structure);
  CHECK_THROWS_AS(world.touches({kNan, 0}, 1), std::invalid_argument);
  CHECK_THROWS_AS(world.touches({0, 0}, {0, kInfinite}, 1), std::invalid_argument);
  CHECK_THROWS_AS(world.touches({0, 0}, {0, 1}, -1e-9), std::invalid_argument);
  CHECK_THROWS_AS(world.touches({0, 0}, {0, 1}, kNan), std::invalid_argument);
  CHECK_THROWS_AS(world.nearest({kInfinite, 0}), std::invalid_argument);
  CHECK_THROWS_AS(world.add(Box{{1, 1}, {0, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(world.move(ObstacleId{0}, {kNan, 0}), std::invalid_argument);
  CHECK_THROWS_WITH(world.move(ObstacleId{5}, {1, 0}), "there is no obstacle 5");
  CHECK_THROWS_AS(world.remove(kNoObstacle), std::invalid_argument);
  world.remove(ObstacleId{0});
  CHECK_THROWS_AS(world.shape(ObstacleId{0}), std::invalid_argument);
}

}  // namespace sidestep::obstacle_world_test
