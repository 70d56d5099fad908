// SPDX-License-Identifier: Apache-2.0
#include "common/collision/baselines/baseline_world.hpp"

#include <set>
#include <tuple>

#include "common/collision/baselines/partition_tree.hpp"
#include "common/collision/baselines/spatial_hash.hpp"
#include "common/collision/baselines/sweep_and_prune.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep::baseline_world_test {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTolerance_m = 1e-9;

/// Calls `call(name, set)` with the name and an empty instance of each structure.
template <typename Call>
void each_structure(const Call& call) {
  const ShapeStore none({});
  call("spatial hash", baselines::SpatialHash(none));
  call("sweep and prune", baselines::SweepAndPrune(none));
  call("K-D tree", baselines::KdTree(none));
  call("BSP tree", baselines::BspTree(none));
}

/// The distance from a path to the nearest obstacle, and the free fraction of the path, by checking all
/// obstacles.
template <typename World>
std::pair<double, double> reference(const World& world, const Vec2& from, const Vec2& to, double radius) {
  double distance2 = kInfinite, fraction = kInfinite;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Shape& shape = world.shape(world.obstacle(i));
    distance2 = std::min(distance2, squared_distance(Segment{from, to}, shape));
    fraction = std::min(fraction, time_of_impact({from, to, radius}, shape).value_or(kInfinite));
  }
  return {std::sqrt(distance2), fraction};
}

/// Checks random queries against the reference and a linear search. Returns the number that touch.
template <typename World>
int check_queries(const World& world, Rng& rng, double half_m, double max_length_m, int queries) {
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < world.size(); ++i) shapes.push_back(world.shape(world.obstacle(i)));
  const ObstacleWorld linear(shapes, Structure::kLinear);
  int touching = 0;
  for (int i = 0; i < queries; ++i) {
    const Vec2 from = random_position(rng, 1.2 * half_m);
    const Vec2 to = from + random_displacement(rng, rng.chance(0.1) ? 4 * half_m : max_length_m);
    // Many radii are close to the distance, where the answer changes.
    const double distance = reference(world, from, to, 0).first;
    double radius = rng.chance(0.1) ? 0 : rng.uniform(0, 0.5 * max_length_m);
    if (rng.chance(0.5) && distance < half_m) radius = std::max(0.0, distance + rng.uniform(-1e-6, 1e-6));
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius, distance);
    if (std::abs(distance - radius) > kTolerance_m) {
      REQUIRE(world.touches(from, to, radius) == (distance < radius));
      REQUIRE(world.touches(from, to, radius) == linear.touches(from, to, radius));
      REQUIRE(world.first_contact(from, to, radius).has_value() == (distance < radius));
    }
    touching += distance < radius;
    const std::optional<Contact> contact = world.first_contact(from, to, radius);
    if (contact) REQUIRE(contact->fraction == Approx(reference(world, from, to, radius).second).margin(1e-9));
    if (contact)
      REQUIRE(time_of_impact({from, to, radius}, world.shape(contact->obstacle)) == contact->fraction);
    const double at_m = reference(world, from, from, 0).first;
    if (std::abs(at_m - radius) > kTolerance_m) REQUIRE(world.touches(from, radius) == (at_m < radius));
  }
  return touching;
}

TEST_CASE("textbook collision structures give the same answers as a linear search") {
  const std::size_t count = GENERATE(1, 2, 15, 64, 300, 1500);
  const std::uint64_t seed = GENERATE(1, 2, 3);
  const double half_m = 5, spacing_m = 2 * half_m / std::sqrt(static_cast<double>(count));
  each_structure([&]<typename Set>(const char* structure, const Set&) {
    CAPTURE(structure, count, seed);
    Rng rng(seed);
    std::vector<Shape> shapes = random_shapes(rng, count, half_m);
    // Some obstacles are much longer than the others.
    for (int i = 0; i < 2; ++i)
      shapes.push_back(Segment{random_position(rng, half_m), random_position(rng, half_m)});
    const baselines::BaselineWorld<Set> world(shapes);
    const int queries = count < 1000 ? 300 : 100;
    const int touching = check_queries(world, rng, half_m, spacing_m, queries);
    CHECK(touching > 0);
    CHECK(touching < queries);
  });
}

TEST_CASE("textbook structures stay correct as obstacles are added, moved and removed") {
  const std::uint64_t seed = GENERATE(range(1, 4));
  const std::size_t count = GENERATE(0, 20, 400);
  each_structure([&]<typename Set>(const char* structure, const Set&) {
    CAPTURE(structure, seed, count);
    Rng rng(seed);
    baselines::BaselineWorld<Set> world(random_shapes(rng, count, 2));
    // At first more obstacles are added than removed, later more are removed.
    for (int round = 0; round < 60; ++round) {
      const double add_probability = round < 30 ? 0.3 : 0.05;
      for (int change = 0; change < 15; ++change) {
        const double choice = rng.uniform();
        if (choice < add_probability || world.size() == 0) {
          world.add(random_shape(rng, 2, 0.3));
          continue;
        }
        const ObstacleId any = world.obstacle(rng.below(world.size()));
        if (choice < 0.5)
          world.remove(any);
        else
          world.move(any, random_displacement(rng, rng.chance(0.1) ? 30 : 0.5));
      }
      check_queries(world, rng, 2, 0.5, 10);
    }
  });
}

TEST_CASE("textbook structures find every obstacle that is barely touched") {
  const std::uint64_t seed = GENERATE(range(1, 4));
  each_structure([&]<typename Set>(const char* structure, const Set&) {
    CAPTURE(structure, seed);
    Rng rng(seed);
    // Boxes side by side on a grid, sharing edges and corners: all coordinates are exact.
    const auto integer = [&] { return static_cast<double>(rng.below(9)) - 4; };
    std::vector<Shape> shapes;
    for (int i = 0; i < 20; ++i) {
      const double y = integer(), x = integer();
      shapes.push_back(Box{{x, y}, {x + 1, y + 1}});
    }
    const baselines::BaselineWorld<Set> world(shapes);
    int touching = 0;
    for (int i = 0; i < 300; ++i) {
      const double from_y = integer(), from_x = integer(), to_y = integer(), to_x = integer();
      const bool is_along_x = rng.chance(0.5);
      const Vec2 from(from_x, from_y), to = is_along_x ? Vec2(to_x, from_y) : Vec2(from_x, to_y);
      const double radius = 0.5 * static_cast<double>(rng.below(3));
      CAPTURE(from.x(), from.y(), to.x(), to.y(), radius);
      const double distance = reference(world, from, to, radius).first;
      REQUIRE(world.touches(from, to, radius) == (distance <= radius));
      touching += distance == radius;
    }
    CHECK(touching > 20);
  });
}

TEST_CASE("textbook structures examine only a few of many obstacles") {
  Rng rng(1);
  constexpr std::size_t kCount = 2000;
  const ShapeStore store(random_shapes(rng, kCount, 5));
  each_structure([&]<typename Set>(const char* structure, const Set&) {
    CAPTURE(structure);
    const Set set(store);
    std::size_t tested = 0;
    constexpr int kQueries = 200;
    for (int i = 0; i < kQueries; ++i) {
      const Vec2 from = random_position(rng, 5), to = from + random_displacement(rng, 0.2);
      const Sweep sweep(from, to, 0.02);
      std::set<Slot> candidates;
      set.any_candidate(sweep, [&](Slot slot) {
        ++tested;
        candidates.insert(slot);
        return false;
      });
      for (const Slot slot : store.slots())
        if (store.touches(slot, sweep)) REQUIRE(candidates.count(slot) == 1);
      // The search ends at the first obstacle that satisfies the predicate.
      std::size_t first = 0;
      const bool found = set.any_candidate(sweep, [&](Slot) { return ++first > 0; });
      REQUIRE(found == !candidates.empty());
      REQUIRE(first <= 1);
    }
    CHECK(tested < 20 * kQueries);
  });
}

TEST_CASE("nothing touches in an empty textbook structure") {
  each_structure([&]<typename Set>(const char* structure, const Set&) {
    CAPTURE(structure);
    baselines::BaselineWorld<Set> world;
    CHECK_FALSE(world.touches({0, 0}, {1, 1}, 100));
    CHECK_FALSE(world.first_contact({0, 0}, {1, 1}, 100).has_value());
    const ObstacleId only = world.add(Circle{{0, 0}, 1});
    CHECK(world.touches({0.5, 0}, 0));
    world.move(only, {1e6, 0});
    CHECK_FALSE(world.touches({0.5, 0}, 0));
    CHECK(world.touches({1e6, 0}, 0));
    world.remove(only);
    CHECK_FALSE(world.touches({1e6, 0}, 0));
    CHECK(world.size() == 0);
  });
}

TEST_CASE("textbook structures reject invalid shapes, queries and ids") {
  each_structure([&]<typename Set>(const char* structure, const Set&) {
    CAPTURE(structure);
    using World = baselines::BaselineWorld<Set>;
    CHECK_THROWS_AS(World({Circle{{0, 0}, -1}}), std::invalid_argument);
    World world({Circle{{0, 0}, 1}});
    CHECK_THROWS_AS(world.touches({kInfinite, 0}, 1), std::invalid_argument);
    CHECK_THROWS_AS(world.touches({0, 0}, {0, 1}, -1e-9), std::invalid_argument);
    CHECK_THROWS_AS(world.add(Box{{1, 1}, {0, 0}}), std::invalid_argument);
    CHECK_THROWS_AS(world.move(ObstacleId{0}, {kInfinite, 0}), std::invalid_argument);
    CHECK_THROWS_WITH(world.move(ObstacleId{5}, {1, 0}), "there is no obstacle 5");
    CHECK_THROWS_AS(world.remove(kNoObstacle), std::invalid_argument);
    CHECK(world.touches({0, 0}, 0));
  });
}

}  // namespace sidestep::baseline_world_test
