// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/bubble_band/bubble_band.hpp"

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/fallback_goal.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::bubble_band_test {

constexpr double kRadius_m = 0.3;

double length_m(std::span<const Vec2> path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

/// The smallest distance of any point from the polyline through the bubbles' centres.
double clearance_m(const BubbleBand& band, std::span<const Vec2> points) {
  const auto bubbles = band.bubbles();
  double nearest2 = 1e9;
  for (std::size_t i = 1; i < bubbles.size(); ++i) {
    const Segment leg{bubbles[i - 1].centre_m, bubbles[i].centre_m};
    for (const Vec2& point : points) nearest2 = std::min(nearest2, squared_distance(point, leg));
  }
  return std::sqrt(nearest2);
}

/// Two walls of points parallel to the x axis, from x = -1 m to 7 m, at y = ± `half_width_m`.
std::vector<Vec2> walls(double half_width_m) {
  std::vector<Vec2> points;
  for (double x = -1; x < 7; x += 0.02) {
    points.emplace_back(x, half_width_m);
    points.emplace_back(x, -half_width_m);
  }
  return points;
}

ObstaclePoints obstacles_of(std::span<const Vec2> points) {
  ObstaclePoints result;
  result.set(points, {0, 0});
  return result;
}

TEST_CASE("forces on bubbles agree with their explicit definition") {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Vec2 before = random_point(rng, 2), at = random_point(rng, 2), after = random_point(rng, 2);
    const double radius = rng.uniform(0.01, 1.5), angle = rng.uniform(0, 6), away_x = std::cos(angle),
                 away_y = std::sin(angle);
    const double cutoff = 2 * kRadius_m;
    double fx = 0, fy = 0;
    for (const Vec2& neighbour : {before, after}) {
      const double dx = neighbour.x() - at.x(), dy = neighbour.y() - at.y(), d = std::sqrt(dx * dx + dy * dy);
      fx += 0.1 * dx / d;
      fy += 0.1 * dy / d;
    }
    if (radius < cutoff) {
      fx += 0.5 * (cutoff - radius) * away_x;
      fy += 0.5 * (cutoff - radius) * away_y;
      fx *= radius / cutoff;
      fy *= radius / cutoff;
    }
    const double length = std::sqrt(fx * fx + fy * fy);
    const double shrink = length > radius / 2 ? radius / 2 / length : 1;
    const Vec2 found = displacement_m(before, {at, radius, {away_x, away_y}, 0}, after, kRadius_m);
    CHECK(found.x() == Approx(shrink * fx).margin(1e-12));
    CHECK(found.y() == Approx(shrink * fy).margin(1e-12));
  }
}

TEST_CASE("the passage between bubbles is as wide as the largest disc that fits through") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Bubble a{{0, 0}, rng.uniform(0.1, 1), {0, 0}, 0};
    const Bubble b{{rng.uniform(0, 1.5), 0}, rng.uniform(0.1, 1), {0, 0}, 0};
    // Slow reference: the largest disc at each position of the axis, limited by the boundary of the union.
    double least = std::min(a.radius_m, b.radius_m);
    for (int k = 0; k <= 200; ++k) {
      const Vec2 at = k / 200.0 * b.centre_m;
      double room = a.radius_m + b.radius_m;
      bool is_inside = false;
      for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
        is_inside = is_inside || (at - one.centre_m).norm() <= one.radius_m;
        for (int i = 0; i < 2000; ++i) {
          const Vec2 edge = one.centre_m + rotated(Vec2(one.radius_m, 0), i * std::numbers::pi / 1000);
          if ((edge - other.centre_m).norm() >= other.radius_m) room = std::min(room, (edge - at).norm());
        }
      }
      least = std::min(least, is_inside ? room : 0.0);
    }
    CHECK(passage_width_m(a, b) == Approx(2 * least).margin(0.02));
  }
  CHECK(passage_width_m({{0, 0}, 1, {0, 0}, 0}, {{0, 0}, 0.5, {0, 0}, 0}) == 1);
  CHECK(passage_width_m({{0, 0}, 1, {0, 0}, 0}, {{3, 0}, 1, {0, 0}, 0}) == 0);
}

TEST_CASE("a band made from a planned path stays free and never becomes longer than the path") {
  int checked = 0;
  double shortened_m = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<Shape> shapes;
    std::vector<Vec2> points;
    for (int i = 0; i < 12; ++i) {
      const double x = rng.uniform(-2.5, 2.5), y = rng.uniform(-2, 2), radius = rng.uniform(0.05, 0.4);
      shapes.emplace_back(Circle{{x, y}, radius});
      for (int k = 0; k < 60; ++k)
        points.push_back(Vec2(x, y) + rotated(Vec2(radius, 0), k * std::numbers::pi / 30));
    }
    const ObstacleWorld world(shapes);
    const Vec2 start(-3.2, 0), goal(3.2, 0);
    LazyVisibility planner;
    const DiscDomain domain(world, Field{10, 8}, 1.1 * kRadius_m, start, goal);
    const Plan<Vec2> plan = plan_with_fallback_goal(planner, domain, start, Budget{}, rng);
    if (plan.states.empty() || plan.states.back() != goal) continue;
    const ObstaclePoints free = obstacles_of(points);
    BubbleBand band(kRadius_m);
    band.start(plan.states, free);
    const double path_m = band.length_m();
    CHECK(path_m == Approx(length_m(plan.states)));
    for (int update = 0; update < 100; ++update) {
      REQUIRE_FALSE(band.is_broken());
      const auto bubbles = band.bubbles();
      REQUIRE(bubbles.front().centre_m == start);
      REQUIRE(bubbles.back().centre_m == goal);
      for (std::size_t i = 1; i < bubbles.size(); ++i)
        REQUIRE(passage_width_m(bubbles[i - 1], bubbles[i]) >= 2 * kRadius_m);
      REQUIRE(clearance_m(band, points) >= kRadius_m - 1e-5);
      band.update(start, free);
    }
    ++checked;
    shortened_m += path_m - band.length_m();
  }
  CHECK(checked >= 10);
  CAPTURE(shortened_m);
}

TEST_CASE("in free space, a band straightens a detour and never becomes longer") {
  BubbleBand band(kRadius_m);
  const std::vector<Vec2> detour{{0, 0}, {1.5, 1.2}, {3, -1}, {4.5, 1.5}, {6, 0}};
  const ObstaclePoints free = obstacles_of({});
  band.start(detour, free);
  for (int update = 0; update < 300; ++update) {
    const double before_m = band.length_m();
    band.update({0, 0}, free);
    REQUIRE(band.length_m() <= before_m + 1e-9);
  }
  CHECK(band.length_m() < 6.05);
  CHECK_FALSE(band.is_broken());
}

TEST_CASE("a band moves aside for an approaching obstacle, and breaks when the passage closes") {
  BubbleBand band(kRadius_m);
  const std::vector<Vec2> walls_m = walls(1.2), path{{0, 0}, {6, 0}};
  band.start(path, obstacles_of(walls_m));
  // A post approaches from the left of the path.
  double y = 1.1;
  std::vector<Vec2> points;
  for (; y > 0.1; y -= 0.01) {
    points = walls_m;
    points.emplace_back(3, y);
    band.update({0, 0}, obstacles_of(points));
    CAPTURE(y);
    REQUIRE_FALSE(band.is_broken());
    REQUIRE(clearance_m(band, points) >= kRadius_m - 1e-5);
  }
  // The band passes to the right of the post, where the passage is now 1.3 m wide.
  CHECK(band.position_m(3).y() < y - kRadius_m);
  // The passage closes once it is narrower than the robot.
  double broken_at_m = 0;
  for (; y > -1 && broken_at_m == 0; y -= 0.01) {
    points = walls_m;
    for (double above = y; above < 1.2; above += 0.1) points.emplace_back(3, above);
    band.update({0, 0}, obstacles_of(points));
    if (!band.is_broken()) REQUIRE(clearance_m(band, points) >= kRadius_m - 1e-5);
    if (band.is_broken()) broken_at_m = y + 1.2;
  }
  CHECK(broken_at_m >= 2 * kRadius_m - 0.02);
  CHECK(broken_at_m < 2.8 * kRadius_m);
}

TEST_CASE("the start of the band follows the robot to the goal") {
  BubbleBand band(kRadius_m);
  const std::vector<Vec2> points = walls(0.5), path{{0, 0}, {2, 0.1}, {6, 0}};
  const ObstaclePoints free = obstacles_of(points);
  band.start(path, free);
  const std::size_t at_first = band.bubbles().size();
  Vec2 robot(0, 0);
  int updates = 0;
  while ((robot - Vec2(6, 0)).norm() > 0.01 && ++updates < 500) {
    robot = band.position_m(0.03);
    band.update(robot, free);
    REQUIRE_FALSE(band.is_broken());
    REQUIRE(band.bubbles().front().centre_m == robot);
  }
  CHECK(updates < 300);
  CHECK(at_first > 8);
  CHECK(band.bubbles().size() == 2);
}

TEST_CASE("bubbles far along the band ignore obstacles near the robot") {
  BubbleBandSettings settings;
  settings.max_masked_m = 4;
  BubbleBand band(kRadius_m, settings);
  CHECK(band.masked_m(2) == 0);
  CHECK(band.masked_m(6) == Approx(2));
  CHECK(band.masked_m(12) == 4);
  // The path returns past the robot: 10 m along the path, it is 0.4 m from a post that is 1 m from the robot.
  const std::vector<Vec2> path{{0, 0}, {5, 0}, {5, 1.4}, {-2, 1.4}};
  const Vec2 post(0, 1);
  const ObstaclePoints free = obstacles_of({&post, 1});
  band.start(path, free);
  double nearest = 1e9;
  for (const Bubble& bubble : band.bubbles()) nearest = std::min(nearest, bubble.radius_m);
  CHECK(nearest > 0.6);
  BubbleBand unmasked(kRadius_m);
  unmasked.start(path, free);
  for (const Bubble& bubble : unmasked.bubbles()) nearest = std::min(nearest, bubble.radius_m);
  CHECK(nearest < 0.6);
}

TEST_CASE("a band avoids obstacles that are given by a distance function") {
  const ObstacleWorld world({Circle{{3, 0.1}, 0.3}});
  const DistanceFunction field([&](const Vec2& at) { return world.nearest(at).distance_m; });
  BubbleBand band(kRadius_m);
  const std::vector<Vec2> path{{0, 0}, {3, -1}, {6, 0}};
  band.start(path, field);
  for (int update = 0; update < 100; ++update) band.update({0, 0}, field);
  CHECK_FALSE(band.is_broken());
  CHECK(band.length_m() < 2 * std::hypot(3, 1) - 0.05);
  for (const Bubble& bubble : band.bubbles()) CHECK(bubble.radius_m >= kRadius_m);
}

TEST_CASE("bands refuse invalid paths, positions and radii") {
  CHECK_THROWS_AS(BubbleBand(0), std::invalid_argument);
  CHECK_THROWS_AS(BubbleBand(2.1), std::invalid_argument);
  BubbleBand band(kRadius_m);
  const ObstaclePoints free;
  CHECK_THROWS_AS(band.update({0, 0}, free), std::invalid_argument);
  CHECK_THROWS_AS(band.start({}, free), std::invalid_argument);
  const std::vector<Vec2> path{{0, 0}, {std::nan(""), 0}};
  CHECK_THROWS_AS(band.start(path, free), std::invalid_argument);
  CHECK(band.is_broken());
}

}  // namespace sidestep::bubble_band_test
