// SPDX-License-Identifier: Apache-2.0
#include "common/motion/clearance.hpp"

#include <algorithm>
#include <limits>

#include "common/motion/trajectory_bounds.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"
#include "tests/unit/common/map/random_map.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::clearance_test {

const Time kBegin = time_from_ns(1'000'000'000);

Trajectory moving(Time start, Vec2 position, Vec2 velocity, Vec2 acceleration, double seconds) {
  Trajectory trajectory(start, {position, velocity});
  trajectory.append(from_seconds(seconds), acceleration);
  append_stop(trajectory, 5);
  return trajectory;
}

/// Independent reference: dense sampling from the later start to the later end, refined by ternary search
/// around the best samples.
double sampled_distance(const Trajectory& a, const Trajectory& b, int samples) {
  const Time from = std::max(a.start(), b.start()), to = std::max({a.end(), b.end(), from});
  const double seconds = to_seconds(to - from);
  const auto at = [&](double t) { return distance_at(a, b, from + from_seconds(t)); };
  double smallest = std::min(at(0), at(seconds));
  const double step = seconds / samples;
  for (int i = 0; i <= samples; ++i) {
    const double here = at(i * step);
    if (here > smallest + 10 * step) continue;  // relative speeds are below 10 m/s
    double low = std::max(0.0, (i - 1) * step), high = std::min(seconds, (i + 1) * step);
    while (high - low > 1e-8) {
      const double third = (high - low) / 3;
      (at(low + third) < at(high - third) ? high : low) +=
          at(low + third) < at(high - third) ? -third : third;
    }
    smallest = std::min({smallest, here, at(0.5 * (low + high))});
  }
  return smallest;
}

TEST_CASE("the clearance never exceeds the distance at any time, over two million random pairs") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int pair = 0; pair < 500'000; ++pair) {
    const Trajectory a = random_trajectory(rng), b = random_trajectory(rng);
    const double clearance = clearance_m(a, b, 0);
    const Time from = std::max(a.start(), b.start());
    const double seconds = std::max(0.01, to_seconds(std::max(a.end(), b.end()) - from));
    for (int i = 0; i < 8; ++i) {
      const double distance = distance_at(a, b, from + from_seconds(rng.uniform(0, 1.1 * seconds)));
      if (clearance > distance) FAIL("pair " << pair << ": " << clearance << " > " << distance);
    }
    const double min_separation_m = rng.uniform(0, 0.5);
    if (is_clear(a, b, min_separation_m) != (clearance_m(a, b, min_separation_m) >= 0))
      FAIL("is_clear() of pair " << pair << " with separation " << min_separation_m);
  }
}

TEST_CASE("the clearance equals the minimum of a dense search to 1 um") {
  const std::uint64_t seed = GENERATE(11u, 12u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int pair = 0; pair < 4000; ++pair) {
    const Trajectory a = random_trajectory(rng), b = random_trajectory(rng);
    const double expected = sampled_distance(a, b, 400), computed = clearance_m(a, b, 0);
    CAPTURE(pair, expected, computed);
    REQUIRE(computed <= expected);
    REQUIRE(computed >= expected - 1e-6);
  }
}

TEST_CASE("the clearance does not depend on the order of the two robots") {
  Rng rng(21);
  for (int pair = 0; pair < 10'000; ++pair) {
    const Trajectory a = random_trajectory(rng), b = random_trajectory(rng);
    REQUIRE(clearance_m(a, b, 0.19) == Approx(clearance_m(b, a, 0.19)).margin(1e-9));
  }
}

TEST_CASE("robots that meet between two samples are not clear") {
  // Relative speed 4 m/s: within 0.19 m of each other for less than 0.1 s.
  const auto a = moving(kBegin, {-1, 0}, {2, 0}, {0, 0}, 0.6),
             b = moving(kBegin, {1, 0.1}, {-2, 0}, {0, 0}, 0.6);
  CHECK(distance_at(a, b, a.start()) > 1.9);
  CHECK(distance_at(a, b, a.end()) > 0.5);
  CHECK(clearance_m(a, b, 0) == Approx(0.1).margin(1e-6));
  CHECK_FALSE(is_clear(a, b, 0.19));
}

TEST_CASE("robots are compared at equal times, so a robot may cross the former position of another") {
  // b crosses the origin 0.5 s after a.
  const auto a = moving(kBegin, {0, 0}, {2, 0}, {0, 0}, 0.5);
  const auto b = moving(kBegin + from_seconds(0.3), {0, -0.6}, {0, 1.5}, {0, 0}, 0.4);
  CHECK(is_clear(a, b, 0.19));
  // Different positions at equal elapsed times, but equal positions at the same absolute time.
  const auto late = moving(kBegin + from_seconds(0.25), {0.6, -0.1}, {0, 1}, {0, 0}, 0.2);
  CHECK_FALSE(is_clear(a, late, 0.19));
}

TEST_CASE("two trajectories are compared from the later of their starts") {
  // Only a's rest position counts: b's trajectory is undefined before its start.
  const auto a = moving(kBegin, {0, 0}, {2, 0}, {0, 0}, 1.0);
  const auto b = Trajectory::resting(kBegin + from_seconds(0.5), {0, 0});
  CHECK(clearance_m(a, b, 0) == Approx(1.0).margin(1e-6));
  CHECK(is_clear(a, b, 0.19));
}

TEST_CASE("the clearance is the smaller of two minima of the distance in either order") {
  // a passes b, reverses and passes b again: one parabola with two close passes.
  const auto b = Trajectory::resting(kBegin, {0, 0.3});
  const auto first_deeper = moving(kBegin, {-0.5, 0.25}, {2.4, 0.1}, {-4, 0}, 1.0);
  const auto second_deeper = moving(kBegin, {-0.5, 0.45}, {2.4, -0.1}, {-4, 0}, 1.0);
  for (const auto* a : {&first_deeper, &second_deeper}) {
    CHECK(clearance_m(*a, b, 0) == Approx(sampled_distance(*a, b, 2000)).margin(1e-6));
  }
  CHECK(clearance_m(second_deeper, b, 0) < 0.08);
}

TEST_CASE("the clearance is exact for equal motions, resting robots and phases of zero duration") {
  const auto a = moving(kBegin, {0, 0}, {1, 1}, {1, 0}, 0.2),
             b = moving(kBegin, {0.3, 0}, {1, 1}, {1, 0}, 0.2);
  CHECK(clearance_m(a, b, 0) == Approx(0.3).margin(1e-8));
  const auto c = Trajectory::resting(kBegin, {0, 0}),
             d = Trajectory::resting(kBegin + from_seconds(3), {0.2, 0});
  CHECK(clearance_m(c, d, 0.19) == Approx(0.01).margin(1e-8));
  CHECK(is_clear(c, d, 0.19));
  CHECK_FALSE(is_clear(c, d, 0.2));
  Trajectory empty(kBegin, {{0, 0.5}, {0, 0}});
  empty.append(Duration{0}, {5, 0});
  empty.append(Duration{0}, {0, 5});
  CHECK(clearance_m(c, empty, 0) == Approx(0.5).margin(1e-8));
}

TEST_CASE("the clearance covers all time, including robots at rest long after their trajectories end") {
  const auto a = moving(kBegin, {0, 0}, {1, 0}, {0, 0}, 0.1);
  const auto b = Trajectory::resting(kBegin + std::chrono::hours(24), a.rest_position_m() + Vec2(0.1, 0));
  CHECK(clearance_m(a, b, 0) == Approx(0.1).margin(1e-8));
}

TEST_CASE("a motion with NaN is not clear of any robot or shape, even at a distance") {
  const double bad = std::numeric_limits<double>::quiet_NaN();
  const Trajectory far = Trajectory::resting(kBegin, {40, 30});
  const Trajectory good = moving(kBegin, {0, 0}, {1, 0.5}, {0.5, 0}, 0.3);
  REQUIRE(is_clear(good, far, 0.2));
  const Trajectory spoilt[] = {
      moving(kBegin, {bad, 0}, {1, 0.5}, {0.5, 0}, 0.3), moving(kBegin, {0, bad}, {1, 0.5}, {0.5, 0}, 0.3),
      moving(kBegin, {0, 0}, {bad, 0.5}, {0.5, 0}, 0.3), moving(kBegin, {0, 0}, {1, 0.5}, {0.5, bad}, 0.3)};
  for (const Trajectory& trajectory : spoilt) {
    CHECK_FALSE(is_clear(trajectory, far, 0.2));
    CHECK_FALSE(is_clear(far, trajectory, 0.2));
    CHECK_FALSE(is_clear(trajectory, Shape(Circle{{40, 30}, 0.1}), 0.2));
    CHECK_FALSE(is_clear(trajectory, Shape(Box{{39, 29}, {41, 31}}), 0.2));
  }
}

TEST_CASE("the clearance from a static disc equals the clearance from a robot at rest") {
  Rng rng(31);
  for (int i = 0; i < 10'000; ++i) {
    const Trajectory a = random_trajectory(rng);
    const Vec2 centre = random_vector(rng, 1);
    const auto resting = Trajectory::resting(a.start(), centre);
    REQUIRE(clearance_m(a, centre, 0.2) == clearance_m(a, resting, 0.2));
    REQUIRE(is_clear(a, centre, 0.2) == is_clear(a, resting, 0.2));
  }
}

TEST_CASE("the clearance from a shape equals the minimum of a dense search") {
  const std::uint64_t seed = GENERATE(41u, 42u, 43u);
  CAPTURE(seed);
  Rng rng(seed);
  int entered = 0, clear = 0;
  for (int i = 0; i < 4000; ++i) {
    const Shape shape = random_shape(rng, 1, 0.4);
    const Trajectory a = random_trajectory(rng);
    const double seconds = to_seconds(a.end() - a.start());
    const auto distance_at = [&](double t) {
      return signed_distance(a.state_at(a.start() + from_seconds(t)).position_m, shape);
    };
    double smallest = distance_at(seconds);
    constexpr int kSamples = 400;
    for (int k = 0; k <= kSamples; ++k) smallest = std::min(smallest, distance_at(k * seconds / kSamples));
    CAPTURE(i, smallest);
    // Between two samples, a robot below 6 m/s comes nearer by less than this.
    const double between_m = 6 * seconds / kSamples / 2;
    const double computed = clearance_m(a, shape, 0);
    const double separation = rng.uniform(0, 0.5);
    if (smallest <= 0 && !std::holds_alternative<Circle>(shape)) {
      ++entered;
      REQUIRE(computed <= 0);
      REQUIRE_FALSE(is_clear(a, shape, separation));
      REQUIRE_FALSE(is_clear(a, shape, -1e9));
      continue;
    }
    REQUIRE(computed <= smallest);
    if (std::isfinite(computed)) REQUIRE(computed >= smallest - between_m - 2 * kClearanceTolerance_m);
    if (!std::isfinite(computed)) REQUIRE(smallest <= between_m + 2 * kClearanceTolerance_m);
    REQUIRE(is_clear(a, shape, separation) == (clearance_m(a, shape, separation) >= 0));
    clear += is_clear(a, shape, separation) ? 1 : 0;
  }
  CHECK(entered > 100);
  CHECK(clear > 100);
}

TEST_CASE("a trajectory is clear of a map if and only if it is clear of every blocked cell and the outside") {
  const std::uint64_t seed = GENERATE(51u, 52u, 53u, 54u);
  CAPTURE(seed);
  Rng rng(seed);
  int clear = 0, clear_by_field = 0, near = 0;
  for (int i = 0; i < 60; ++i) {
    MapGrid grid;
    grid.columns = 20 + static_cast<int>(rng.below(40)), grid.rows = 20 + static_cast<int>(rng.below(40));
    grid.resolution_m = rng.uniform(0.05, 0.2);
    grid.origin_m = random_vector(rng, 0.5) - 0.5 * grid.resolution_m * Vec2(grid.columns, grid.rows);
    const FloorMap map({grid, test::noise(rng, grid.columns, grid.rows, rng.uniform(0, 0.03))});
    std::vector<Box> cells = test::blocked_boxes(map.cells());
    // The outside, as four boxes.
    const Box inside = map.cells().extent(), all = inflated(inside, 1e3);
    cells.push_back({all.min_m, {inside.min_m.x(), all.max_m.y()}});
    cells.push_back({all.min_m, {all.max_m.x(), inside.min_m.y()}});
    cells.push_back({{inside.max_m.x(), all.min_m.y()}, all.max_m});
    cells.push_back({{all.min_m.x(), inside.max_m.y()}, all.max_m});
    for (int k = 0; k < 40; ++k) {
      const Trajectory a = random_trajectory(rng);
      const double separation = rng.uniform(0, 0.3);
      double clearance = std::numeric_limits<double>::infinity();
      for (const Box& cell : cells) clearance = std::min(clearance, clearance_m(a, Shape(cell), separation));
      CAPTURE(i, k, clearance);
      // The edges of merged cells are rounded like those of single cells.
      if (std::abs(clearance) > 1e-9) REQUIRE(is_clear(a, map, separation) == (clearance >= 0));
      clear += clearance >= 0 ? 1 : 0;
      near += std::abs(clearance) < 0.1 ? 1 : 0;
      const Circle disc = disc_of(a);
      clear_by_field += map.field().lower_bound_m(disc.centre_m) > disc.radius_m + separation + 1e-6 ? 1 : 0;
    }
  }
  CHECK(clear > 100);
  CHECK(clear < 2300);
  CHECK(near > 100);
  CHECK(clear_by_field > 10);
}

TEST_CASE("a trajectory that leaves the map after more than a hundred metres is not clear") {
  MapGrid grid;
  grid.columns = grid.rows = 400, grid.origin_m = {-10, -10};
  const FloorMap map(OccupancyMap(grid, BitGrid(grid.columns, grid.rows)));
  Trajectory a(kBegin, {{0, 0}, {0, 0}});
  a.append(from_seconds(1), {2, 0});
  a.append(from_seconds(25), {-0.16, 0});
  a.append(from_seconds(25), {0.16, 0});
  append_stop(a, 4);
  CHECK((a.rest_position_m() - Vec2(1.5, 0)).norm() < 1e-6);
  CHECK_FALSE(is_clear(a, map, 0.1));
  grid.columns = grid.rows = 800, grid.origin_m = {-20, -20};
  CHECK(is_clear(a, FloorMap(OccupancyMap(grid, BitGrid(grid.columns, grid.rows))), 0.1));
}

}  // namespace sidestep::clearance_test
