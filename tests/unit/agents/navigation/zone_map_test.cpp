// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/zone_map.hpp"

#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::zone_map_test {

Order zone(std::vector<Vec2> corners, double radius, std::optional<double> limit_mps = std::nullopt) {
  Order order{msg::OrderKind::ORDER_ZONE, kAllRobots, 1'000'001, 1};
  order.zone_number = 7;
  order.zone = {std::move(corners), radius, limit_mps};
  return order;
}

/// Independent slow reference: the convex hull is the union of the triangles of all triples of corners.
double distance_from_hull(const Vec2& p, const std::vector<Vec2>& corners) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec2& a : corners) {
    for (const Vec2& b : corners) {
      for (int i = 0; i <= 200; ++i) nearest = std::min(nearest, (a + i / 200.0 * (b - a) - p).norm());
      for (const Vec2& c : corners) {
        const double ab = cross(b - a, p - a), bc = cross(c - b, p - b), ca = cross(a - c, p - c);
        if (ab > 0 && bc > 0 && ca > 0) return 0;
      }
    }
  }
  return nearest;
}

TEST_CASE("a zone is the convex hull of its corners, expanded by its radius") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    std::vector<Vec2> corners(1 + rng.below(6));
    for (Vec2& corner : corners) corner = Vec2(rng.uniform(-2, 2), rng.uniform(-2, 2));
    if (rng.below(4) == 0) corners.push_back(corners.front());
    const double radius = rng.below(3) == 0 ? 0 : rng.uniform(0.05, 1);
    const Shape outline = outline_of(zone(corners, radius).zone);
    REQUIRE_NOTHROW(check(outline));
    for (int i = 0; i < 100; ++i) {
      const Vec2 p(rng.uniform(-3, 3), rng.uniform(-3, 3));
      const double reference = distance_from_hull(p, corners) - radius;
      const double distance = signed_distance(p, outline);
      CAPTURE(seed, corners.size(), radius, p.transpose(), reference, distance);
      if (reference < -0.002) REQUIRE(distance <= 0.002);
      if (reference > 0) {
        REQUIRE(distance <= reference + 0.002);
        REQUIRE(distance >= reference - 0.01 * radius - 0.02);
      }
    }
  }
}

TEST_CASE("robots keep out of zones without a speed limit") {
  const std::vector<Order> orders{zone({{1, 0}}, 0.5), zone({{-1, -1}, {-1, 1}}, 0, 0.5)};
  const ZoneMap zones(orders);
  REQUIRE(zones.keep_outs().size() == 1);
  CHECK(zones.keep_out_numbers()[0] == 7);
  CHECK(zones.is_kept_out({1.59, 0}, 0.1));
  CHECK_FALSE(zones.is_kept_out({1.61, 0}, 0.1));
  CHECK_FALSE(zones.is_kept_out({-1, 0}, 0.1));
  CHECK_FALSE(ZoneMap().is_kept_out({0, 0}, 1));
}

TEST_CASE("a robot that brakes as late as a speed zone permits enters the zone at most at its limit") {
  const MotionLimits limits;
  const std::vector<Order> orders{zone({{0, -1}, {0, 1}, {2, 1}, {2, -1}}, 0, 0.5)};
  const ZoneMap zones(orders);
  const Duration cycle = from_seconds(1.0 / 60);
  double x = -2, speed = limits.speed_mps;
  while (x < 0.5) {
    const double max_mps = zones.max_speed_mps({x, 0}, speed, 0.09, 2 * cycle, limits);
    const double change = limits.deceleration_mps2 * to_seconds(cycle);
    REQUIRE(speed <= max_mps + change);
    speed = std::min(limits.speed_mps, std::max(max_mps, speed - change));
    if (x + 0.09 >= 0) REQUIRE(speed <= 0.5 + 1e-9);
    x += speed * to_seconds(cycle);
  }
  CHECK(ZoneMap().max_speed_mps({0, 0}, 1, 0.09, cycle, limits) == std::numeric_limits<double>::infinity());
}

}  // namespace sidestep::zone_map_test
