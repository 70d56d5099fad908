// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/dynamic_window.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::drive_among_posts_test {

const ConvexPolygon kHull = pointed_hull();

/// A robot that uses the dynamic window to drive among random posts.
struct Drive {
  DifferentialDrive drive;
  std::vector<Vec2> posts_m;
  Vec2 position_m{0, 0}, goal_m{0, 0};
  double heading_rad = 0;
  WheelSpeeds wheels;

  Vec2 seen(const Vec2& at) const { return rotated(at - position_m, -heading_rad); }

  /// Drives for a cycle. Returns the smallest distance of a post from the hull.
  double step(DynamicWindow& window, double cycle_s) {
    std::vector<Vec2> points;
    for (const Vec2& post : posts_m) points.push_back(seen(post));
    WindowQuery query;
    query.points_m = points;
    query.wheels = wheels;
    query.goal.position_m = seen(goal_m);
    query.cycle_s = cycle_s;
    const WindowChoice& choice = window.choose(query);
    REQUIRE_FALSE(choice.is_touching);
    wheels = choice.command;
    double nearest = 1e9;
    for (int i = 0; i < 10; ++i) {
      const ArcMotion motion = drive.motion(wheels);
      position_m += rotated(displacement_m(motion, cycle_s / 10), heading_rad);
      heading_rad += motion.turn_rate_radps * cycle_s / 10;
      for (const Vec2& post : posts_m)
        nearest = std::min(nearest, signed_distance(seen(post), kHull.corners_m));
    }
    return nearest;
  }
};

TEST_CASE("a robot among random posts reaches most goals and touches nothing") {
  DynamicWindow window(DifferentialDrive{}, kHull, {.cell_m = 0.05});
  int arrived = 0;
  constexpr int kRuns = 20;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Drive robot;
    robot.goal_m = {3.5, rng.uniform(-1, 1)};
    for (int i = 0; i < 5; ++i) {
      const Vec2 post(rng.uniform(0.6, 3), rng.uniform(-1.5, 1.5));
      if ((post - robot.goal_m).norm() > 0.5) robot.posts_m.push_back(post);
    }
    bool is_there = false;
    for (int cycle = 0; cycle < 400 && !is_there; ++cycle) {
      REQUIRE(robot.step(window, 0.1) > 0.02 - 1e-6);  // the padding of the hull
      is_there = (robot.position_m - robot.goal_m).norm() <= 0.1;
    }
    arrived += is_there ? 1 : 0;
  }
  // The method is local, so some robots get stuck.
  CHECK(arrived >= kRuns / 2);
}

}  // namespace sidestep::drive_among_posts_test
