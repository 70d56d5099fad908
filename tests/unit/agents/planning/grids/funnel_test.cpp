// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/funnel.hpp"

#include <algorithm>
#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::funnel_test {

constexpr double kTolerance_m = 1e-9;

double length_of(const std::vector<Vec2>& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

/// Whether the straight line between two points passes through all vertical portals between them.
bool passes(const Vec2& from, const Vec2& to, std::span<const PortalEdge> portals) {
  for (const PortalEdge& portal : portals) {
    const double x = portal.left_m.x();
    if (x <= from.x() || x >= to.x()) continue;
    const double y = from.y() + (to.y() - from.y()) * (x - from.x()) / (to.x() - from.x());
    if (y > portal.left_m.y() + kTolerance_m || y < portal.right_m.y() - kTolerance_m) return false;
  }
  return true;
}

/// The length of the shortest path over portal ends, found by comparing all such paths.
double shortest_m(const Vec2& from, const std::vector<PortalEdge>& portals, const Vec2& to) {
  std::vector<Vec2> points{from};
  for (const PortalEdge& portal : portals) points.insert(points.end(), {portal.left_m, portal.right_m});
  points.push_back(to);
  std::vector<double> length(points.size(), std::numeric_limits<double>::infinity());
  length[0] = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (points[k].x() < points[i].x() && passes(points[k], points[i], portals))
        length[i] = std::min(length[i], length[k] + (points[i] - points[k]).norm());
  return length.back();
}

TEST_CASE("the path through portals is the shortest path") {
  const std::uint64_t seed = GENERATE(range(1, 101));
  CAPTURE(seed);
  Rng rng(seed);
  const std::size_t count = rng.below(30);
  const double wander_m = rng.uniform(0.1, 2), height_m = rng.uniform(0.01, 3);
  std::vector<PortalEdge> portals;
  double middle_m = 0;
  for (std::size_t i = 0; i < count; ++i) {
    middle_m += rng.uniform(-wander_m, wander_m);
    const auto x = static_cast<double>(i + 1);
    const double above_m = rng.uniform(0, height_m), below_m = rng.uniform(0, height_m);
    portals.push_back({{x, middle_m + above_m}, {x, middle_m - below_m}});
    // Some portals share an end with the previous portal.
    if (i > 0 && rng.chance(0.2))
      portals[i].left_m.y() = std::max(portals[i - 1].left_m.y(), portals[i].right_m.y());
  }
  const Vec2 from(0, rng.uniform(-1, 1)), to(static_cast<double>(count + 1), rng.uniform(-1, 1) + middle_m);
  std::vector<Vec2> path;
  write_shortest_through(from, portals, to, path);
  REQUIRE(path.front() == from);
  REQUIRE(path.back() == to);
  for (std::size_t i = 1; i < path.size(); ++i) REQUIRE(passes(path[i - 1], path[i], portals));
  CHECK(length_of(path) == Approx(shortest_m(from, portals, to)).epsilon(1e-9));

  // The reversed path has the same length.
  std::vector<PortalEdge> reversed;
  for (auto portal = portals.rbegin(); portal != portals.rend(); ++portal)
    reversed.push_back({portal->right_m, portal->left_m});
  std::vector<Vec2> back;
  write_shortest_through(to, reversed, from, back);
  CHECK(length_of(back) == Approx(length_of(path)).epsilon(1e-9));
}

TEST_CASE("a path turns only once around the common end of several portals") {
  // The portals are arranged like the spokes of a wheel and passed clockwise.
  const Vec2 hub(0, 0);
  const std::vector<PortalEdge> portals{
      {{-1, 0}, hub}, {{-1, 1}, hub}, {{0, 1}, hub}, {{1, 1}, hub}, {{1, 0}, hub}};
  std::vector<Vec2> path;
  write_shortest_through({-0.5, -1}, portals, {0.5, -1}, path);
  CHECK(path == std::vector<Vec2>{{-0.5, -1}, hub, {0.5, -1}});
}

TEST_CASE("a path without portals is straight") {
  std::vector<Vec2> path{{7, 7}};
  write_shortest_through({0, 0}, {}, {1, 1}, path);
  CHECK(path == std::vector<Vec2>{{0, 0}, {1, 1}});
}

}  // namespace sidestep::funnel_test
