// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/detected_obstacles.hpp"

#include <algorithm>
#include <vector>

#include "common/protocol/obstacle_bounds.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::detected_obstacles_test {

Vec2 random_position(Rng& rng) {
  const double x = rng.uniform(-5, 5), y = rng.uniform(-3, 3);
  return {x, y};
}

msg::DetectionFrame frame_with_robots(std::uint64_t count, Rng& rng) {
  msg::DetectionFrame frame;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vec2 position = random_position(rng);
    msg::RobotDetection& robot = frame.robots().emplace_back();
    robot.x_m(position.x());
    robot.y_m(position.y());
  }
  return frame;
}

double distance_m(const Circle& obstacle, const msg::DetectionFrame& frame) {
  double min_distance = 1e9;
  for (const msg::RobotDetection& robot : frame.robots())
    min_distance = std::min(min_distance, (obstacle.centre_m - Vec2(robot.x_m(), robot.y_m())).norm());
  return min_distance - obstacle.radius_m;
}

TEST_CASE("a frame lists every obstacle within the range for which it claims to be complete") {
  const std::uint64_t seed = GENERATE(range(1u, 40u));
  CAPTURE(seed);
  Rng rng(seed);
  msg::DetectionFrame frame = frame_with_robots(1 + rng.below(10), rng);
  std::vector<Circle> crowd;
  for (std::uint64_t left = rng.below(600); left > 0; --left) {
    const Vec2 position = random_position(rng);
    crowd.push_back({position, rng.uniform(0.02, 0.4)});
  }
  std::vector<Circle> detected = crowd;
  set_obstacles(detected, frame);
  REQUIRE(frame.obstacle_count() == std::min<std::size_t>(crowd.size(), msg::MAX_OBSTACLES));
  const double complete_within_m = frame.obstacles_complete_within_m();
  if (crowd.size() <= msg::MAX_OBSTACLES) CHECK(complete_within_m == kCompleteEverywhere_m);
  double farthest_m = 0;
  for (const Circle& obstacle : crowd) {
    const auto is_same = [&](const msg::ObstacleDetection& listed) {
      return Vec2(listed.x_m(), listed.y_m()) == obstacle.centre_m && listed.radius_m() == obstacle.radius_m;
    };
    const auto listed_end = frame.obstacles().begin() + frame.obstacle_count();
    const bool is_listed = std::any_of(frame.obstacles().begin(), listed_end, is_same);
    if (!is_listed) REQUIRE(distance_m(obstacle, frame) >= complete_within_m);
    if (is_listed) farthest_m = std::max(farthest_m, distance_m(obstacle, frame));
  }
  if (crowd.size() > msg::MAX_OBSTACLES) CHECK(complete_within_m == Approx(farthest_m));
}

TEST_CASE("a frame without robots that cannot hold all obstacles claims no completeness") {
  msg::DetectionFrame frame;
  std::vector<Circle> detected(msg::MAX_OBSTACLES, {{1, 1}, 0.1});
  set_obstacles(detected, frame);
  CHECK(frame.obstacles_complete_within_m() == kCompleteEverywhere_m);
  detected.push_back({{2, 2}, 0.1});
  set_obstacles(detected, frame);
  CHECK(frame.obstacle_count() == msg::MAX_OBSTACLES);
  CHECK(frame.obstacles_complete_within_m() == 0);
  set_obstacles({}, frame);
  CHECK(frame.obstacle_count() == 0);
  CHECK(frame.obstacles_complete_within_m() == kCompleteEverywhere_m);
}

}  // namespace sidestep::detected_obstacles_test
