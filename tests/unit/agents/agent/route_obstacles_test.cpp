// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/route_obstacles.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::route_obstacles_test {

const std::vector<Shape> kFixed{Circle{{3, 3}, 0.5}, Box{{-3, -3}, {-2, -2}}};

ZoneMap one_zone() {
  Order order;
  order.kind = msg::OrderKind::ORDER_ZONE;
  order.zone_number = 17;
  order.zone = {{{3, -3}}, 0.4};
  return ZoneMap(std::vector<Order>{order});
}

std::vector<TemporaryObstacle> random_temporary(Rng& rng) {
  std::vector<TemporaryObstacle> obstacles(rng.below(6));
  for (TemporaryObstacle& obstacle : obstacles) {
    const double y = rng.uniform(-1, 1), x = rng.uniform(-1, 1);
    obstacle.circle = {{x, y}, rng.chance(0.5) ? 0.09 : 0.2};
    if (rng.chance(0.5)) obstacle.robot = static_cast<RobotId>(rng.below(20));
  }
  return obstacles;
}

FloorRules rules_with(const std::vector<Shape>& obstacles) {
  FloorRules rules;
  rules.obstacles = obstacles;
  return rules;
}

TEST_CASE("an updated world contains exactly the current obstacles, and blockages name the nearest of them") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  RouteObstacles obstacles(rules_with(kFixed), one_zone());
  for (int change = 0; change < 300; ++change) {
    const std::vector<TemporaryObstacle> temporary = random_temporary(rng);
    obstacles.set_temporary(temporary);
    CHECK_FALSE(obstacles.set_temporary(temporary));
    REQUIRE(obstacles.world().size() == kFixed.size() + 1 + temporary.size());
    for (int i = 0; i < 10; ++i) {
      const double y = rng.uniform(-4, 4), x = rng.uniform(-4, 4);
      const Vec2 p(x, y);
      double nearest_m = (p - Vec2(3, -3)).norm() - 0.4;
      Blockage expected{msg::BlockReason::BLOCK_ZONE, 17};
      for (const Shape& shape : kFixed) {
        if (signed_distance(p, shape) >= nearest_m) continue;
        nearest_m = signed_distance(p, shape);
        expected = {msg::BlockReason::BLOCK_OBSTACLE, 0, centre_m(shape)};
      }
      for (const auto& [circle, robot] : temporary) {
        if (signed_distance(p, circle) >= nearest_m) continue;
        nearest_m = signed_distance(p, circle);
        expected = {robot ? msg::BlockReason::BLOCK_ROBOT : msg::BlockReason::BLOCK_OBSTACLE,
                    robot.value_or(0), circle.centre_m};
      }
      const Nearest found = obstacles.world().nearest(p);
      REQUIRE(found.distance_m == Approx(nearest_m).margin(1e-9));
      const Blockage blockage = obstacles.blockage(found.obstacle);
      REQUIRE(blockage.reason == expected.reason);
      REQUIRE(blockage.blocker == expected.blocker);
      REQUIRE((blockage.blocker_m - expected.blocker_m).norm() < 1e-9);
    }
  }
}

TEST_CASE("obstacles of equal size keep their ids when they move") {
  RouteObstacles obstacles(rules_with(kFixed), ZoneMap{});
  obstacles.set_temporary(std::vector<TemporaryObstacle>{{{{0, 0}, 0.1}}, {{{1, 0}, 0.1}}});
  const std::vector<ObstacleId> before = obstacles.world().obstacles();
  CHECK(obstacles.set_temporary(std::vector<TemporaryObstacle>{{{{0.1, 0}, 0.1}}, {{{1, 0.1}, 0.1}}}));
  CHECK(obstacles.world().obstacles() == before);
}

TEST_CASE("a map's blocked cells are permanent obstacles for routes, and robots are temporary obstacles") {
  MapGrid grid;
  grid.columns = grid.rows = 60, grid.resolution_m = 0.1, grid.origin_m = {-3, -3};
  BitGrid blocked(grid.columns, grid.rows);
  for (int row = 10; row < 50; ++row) blocked.set(30, row);
  FloorRules rules = rules_with({Circle{{2, 0}, 0.3}});
  rules.map = std::make_shared<const FloorMap>(OccupancyMap(grid, blocked));
  RouteObstacles obstacles(rules, ZoneMap{});
  obstacles.set_temporary(std::vector<TemporaryObstacle>{{{{-1, 0}, 0.2}, 3}});
  CHECK(obstacles.world().touches({0.05, 1.9}, 0.05));
  CHECK(obstacles.world().touches({-1, 0}, 0.05));
  CHECK_FALSE(obstacles.world().touches({0.05, 2.2}, 0.05));
  const ObstacleWorld fixed = obstacles.fixed_world();
  CHECK(fixed.touches({0.05, 1.9}, 0.05));
  CHECK(fixed.touches({2, 0}, 0.05));
  CHECK_FALSE(fixed.touches({-1, 0}, 0.05));
  CHECK(obstacles.world().touches({-1, 0}, 0.05));
}

}  // namespace sidestep::route_obstacles_test
