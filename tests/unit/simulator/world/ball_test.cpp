// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/ball.hpp"

#include <vector>

#include "tests/catch.hpp"

namespace sidestep::ball_test {

void roll(Ball& ball, int steps, const Field& field, std::span<const Shape> obstacles = {},
          std::span<const Body> robots = {}) {
  for (int i = 0; i < steps; ++i) ball.step(field, obstacles, nullptr, robots, 0.09);
}

TEST_CASE("a ball rolls for a distance of v^2 / 2a and then rests") {
  Ball ball({{-4, 0}, {1.2, 0.9}});
  roll(ball, 6000, {20, 20});
  CHECK((ball.state().position_m - Vec2(-4 + 0.8 * 3.75, 0.6 * 3.75)).norm() < 1e-6);
  CHECK(ball.state().velocity_mps.norm() == 0);
}

TEST_CASE("a ball bounces off every wall with reduced speed and never leaves the field") {
  const Vec2 direction = GENERATE(Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1), Vec2(0.6, 0.8));
  const Field field{2, 1};
  Ball ball({{0, 0}, 3 * direction});
  double speed = 3;
  bool has_bounced = false;
  for (int i = 0; i < 5000; ++i) {
    roll(ball, 1, field);
    REQUIRE(field.contains(ball.state().position_m, RollingBall::kRadius_m - 1e-12));
    REQUIRE(ball.state().velocity_mps.norm() <= speed);
    speed = ball.state().velocity_mps.norm();
    has_bounced = has_bounced || ball.state().velocity_mps.dot(direction) < 0;
  }
  CHECK(has_bounced);
}

TEST_CASE("a ball bounces off an obstacle") {
  const Shape obstacle = GENERATE(Shape(Circle{{1, 0}, 0.1}), Shape(Box{{0.9, -1}, {1, 1}}),
                                  Shape(ConvexPolygon{{{0.9, -1}, {2, 0}, {0.9, 1}}}));
  Ball ball({{0, 0}, {2, 0}});
  roll(ball, 1000, {9, 6}, {&obstacle, 1});
  CHECK(ball.state().velocity_mps.x() < 0);
  CHECK(ball.state().position_m.x() < 1 - 0.1 - 0.0215);
}

TEST_CASE("a robot pushes a ball ahead of it") {
  std::vector<Body> robots(1, Body({0, 0}, 0, {}));
  Ball ball({{0.3, 0}, {0, 0}});
  for (int i = 0; i < 600; ++i) {
    robots[0].step({Vec2(2, 0), 0});
    ball.step({9, 6}, {}, nullptr, robots, 0.09);
    const double apart = (ball.state().position_m - robots[0].position_m()).norm();
    REQUIRE(apart >= 0.09 + RollingBall::kRadius_m - 1e-9);
  }
  CHECK(ball.state().position_m.x() > 0.3);
  CHECK(ball.state().velocity_mps.x() >= robots[0].velocity_mps().x() - 0.01);
}

TEST_CASE("a ball exactly below a robot's centre is moved out to one side") {
  const std::vector<Body> robots(1, Body({0, 0}, 0, {}));
  Ball ball({{0, 0}, {0, 0}});
  roll(ball, 1, {9, 6}, {}, robots);
  CHECK(ball.state().position_m.norm() == Approx(0.09 + 0.0215));
}

TEST_CASE("a ball bounces off blocked cells of a map") {
  MapGrid grid;
  grid.columns = grid.rows = 60, grid.resolution_m = 0.1, grid.origin_m = {-3, -3};
  BitGrid blocked(grid.columns, grid.rows);
  for (int row = 20; row < 40; ++row) blocked.set(40, row);  // from x = 1 m to x = 1.1 m
  const FloorMap map(OccupancyMap(grid, blocked));
  Ball ball({{0, 0}, {2, 0}});
  double farthest_m = 0;
  for (int i = 0; i < 3000; ++i) {
    ball.step({9, 6}, {}, &map, {}, 0.09);
    farthest_m = std::max(farthest_m, ball.state().position_m.x());
  }
  CHECK(farthest_m == Approx(1 - RollingBall::kRadius_m).margin(0.003));
  CHECK(ball.state().position_m.x() < 0.9);
}

}  // namespace sidestep::ball_test
