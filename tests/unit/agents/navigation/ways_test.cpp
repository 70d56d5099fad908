// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/ways.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <queue>

#include "common/random/rng.hpp"

using namespace sidestep;

namespace {

constexpr double kRadius_m = 0.09, kMargin_m = 0.02;
const Field kField{4, 4};

/// Independent and slow: Dijkstra on an 8-connected grid of 2 cm; its ways are at most 8.3 % longer than the
/// shortest.
double grid_length(const std::vector<Circle>& obstacles, const Vec2& start, const Vec2& goal, double grown) {
  const int n = 200;
  const double step = 4.0 / n;
  const auto cell = [&](const Vec2& p) {
    return std::pair{static_cast<int>((p.x() + 2) / step), static_cast<int>((p.y() + 2) / step)};
  };
  std::vector<double> length(n * n, std::numeric_limits<double>::infinity());
  const auto at = [&](int x, int y) -> double& { return length[static_cast<std::size_t>(x * n + y)]; };
  using Item = std::tuple<double, int, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
  const auto [sx, sy] = cell(start);
  at(sx, sy) = 0;
  open.push({0, sx, sy});
  while (!open.empty()) {
    const auto [d, x, y] = open.top();
    open.pop();
    if (d > at(x, y)) continue;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const int i = x + dx, j = y + dy;
        if (i < 0 || j < 0 || i >= n || j >= n) continue;
        const Vec2 p(-2 + (i + 0.5) * step, -2 + (j + 0.5) * step);
        bool free = kField.contains(p, kRadius_m);
        for (const Circle& o : obstacles) free = free && (p - o.centre_m).norm() > o.radius_m + grown;
        const double next = d + step * std::hypot(dx, dy);
        if (!free || next >= at(i, j)) continue;
        at(i, j) = next;
        open.push({next, i, j});
      }
    }
  }
  const auto [gx, gy] = cell(goal);
  return at(gx, gy);
}

}  // namespace

TEST_CASE("without obstacles the way is straight") {
  Ways ways({}, kField, kRadius_m, kMargin_m, 0, {1, 1});
  const auto route = ways.route_from({-1, -1});
  REQUIRE(route);
  CHECK(route->waypoint_m == Vec2(1, 1));
  CHECK(route->length_m == Approx(2 * std::sqrt(2.0)));
}

TEST_CASE("the way leads round obstacles, clear of them, and is hardly longer than the shortest") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u, 6u);
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Circle> obstacles;
  for (int i = 0; i < 12; ++i) {
    const Vec2 centre(rng.uniform(-1.2, 1.2), rng.uniform(-1.2, 1.2));
    obstacles.push_back({centre, rng.uniform(0.05, 0.25)});
  }
  const Vec2 start(-1.8, -1.8), goal(1.8, 1.8);
  Ways ways(obstacles, kField, kRadius_m, kMargin_m, 0, goal);
  const double reference = grid_length(obstacles, start, goal, kRadius_m + kMargin_m + 0.02);
  REQUIRE(reference < 20);
  Vec2 here = start;
  double walked = 0;
  auto route = ways.route_from(here);
  REQUIRE(route);
  CHECK(route->length_m <= reference);
  const double promised = route->length_m;
  for (int leg = 0; leg < 50 && (here - goal).norm() > 1e-9; ++leg) {
    route = ways.route_from(here);
    REQUIRE(route);
    for (int k = 0; k <= 100; ++k) {
      const Vec2 p = here + k / 100.0 * (route->waypoint_m - here);
      for (const Circle& o : obstacles)
        REQUIRE((p - o.centre_m).norm() >= o.radius_m + kRadius_m + kMargin_m - 1e-9);
    }
    walked += (route->waypoint_m - here).norm();
    here = route->waypoint_m;
  }
  CHECK(walked == Approx(promised));
}

TEST_CASE("a goal that is walled in has no way to it") {
  std::vector<Circle> ring;
  for (int i = 0; i < 12; ++i) ring.push_back({0.5 * Vec2(std::cos(i * 0.5236), std::sin(i * 0.5236)), 0.15});
  Ways ways(ring, kField, kRadius_m, kMargin_m, 0, {0, 0});
  CHECK_FALSE(ways.route_from({1.5, 0}));
}

TEST_CASE("a robot that stands too near an obstacle may leave it but not go through it") {
  Ways ways({{{0, 0}, 0.2}}, kField, kRadius_m, kMargin_m, 0, {1, 0});
  const Vec2 near(-0.25, 0);
  const auto route = ways.route_from(near);
  REQUIRE(route);
  CHECK(route->waypoint_m != Vec2(1, 0));
  CHECK((route->waypoint_m - near).dot(near) >= 0);
}

TEST_CASE("of two ways that are equally long the same is kept while the robot drifts aside") {
  const Circle middle{{0, 0}, 0.3};
  Ways ways({middle}, kField, kRadius_m, kMargin_m, 0, {1.5, 0});
  Vec2 here(-1.5, 1e-3);
  const auto first = ways.route_from(here);
  REQUIRE(first);
  const double side = first->waypoint_m.y();
  REQUIRE(side != 0);
  double length = first->length_m;
  while ((here - Vec2(1.5, 0)).norm() > 0.05) {
    const auto route = ways.route_from(here);
    REQUIRE(route);
    CHECK(route->waypoint_m.y() * side >= 0);
    CHECK(route->length_m < length + 0.05);
    length = route->length_m;
    const Vec2 ahead = (route->waypoint_m - here).normalized();
    // Wavers across the line where both are equally long.
    const double wavers = here.x() < -0.8 ? -0.004 * std::copysign(1.0, here.y()) : 0;
    here += 0.02 * ahead + Vec2(0, wavers);
  }
}

TEST_CASE("a way that others push a robot off from is found anew") {
  Ways ways({{{0, 0}, 0.3}}, kField, kRadius_m, kMargin_m, 0, {1.5, 0});
  const auto above = ways.route_from({-0.5, 0.3});
  REQUIRE(above);
  CHECK(above->waypoint_m.y() > 0);
  const auto below = ways.route_from({-0.5, -0.3});
  REQUIRE(below);
  CHECK(below->waypoint_m.y() < 0);
}

TEST_CASE("ways keep room where there is some and do without where there is none") {
  const double room = 0.05;
  const std::vector<Circle> pair{{{0, 0.4}, 0.2}, {{0, -0.4}, 0.2}};
  Ways wide(pair, kField, kRadius_m, kMargin_m, room, {1.5, 0.3});
  const auto roomy = wide.route_from({-1.5, 0.3});
  REQUIRE(roomy);
  CHECK((roomy->waypoint_m - pair[0].centre_m).norm() >= 0.2 + kRadius_m + kMargin_m + room);

  // The gap between a wall of discs and one of them is too narrow for room.
  std::vector<Circle> wall;
  for (int i = -4; i <= 4; ++i) {
    if (i != 0) wall.push_back({{0, 0.45 * i + std::copysign(0.08, i)}, 0.3});
  }
  const double gap = 2 * (0.45 + 0.08 - 0.3);
  REQUIRE(gap / 2 > kRadius_m + kMargin_m);
  REQUIRE(gap / 2 < kRadius_m + kMargin_m + 0.15);
  Ways narrow(wall, kField, kRadius_m, kMargin_m, 0.15, {1.5, 0.2});
  const auto tight = narrow.route_from({-1.5, 0.2});
  REQUIRE(tight);
  for (const Circle& disc : wall)
    CHECK((tight->waypoint_m - disc.centre_m).norm() >= disc.radius_m + kRadius_m + kMargin_m - 1e-9);
}
