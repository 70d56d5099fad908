// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/detected_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/protocol/obstacle_bounds.hpp"

namespace sidestep {
namespace {

/// Distance from the centre of the frame's nearest robot to the obstacle's edge; infinite without robots.
double robot_distance_m(const Circle& obstacle, const msg::DetectionFrame& frame) {
  double min_squared = std::numeric_limits<double>::infinity();
  for (const msg::RobotDetection& robot : frame.robots())
    min_squared = std::min(min_squared, (obstacle.centre_m - Vec2(robot.x_m(), robot.y_m())).squaredNorm());
  return std::sqrt(min_squared) - obstacle.radius_m;
}

/// Moves the nearest obstacles to the front. Returns the distance up to which they are complete.
double select_nearest(std::span<Circle> detected, std::size_t count, const msg::DetectionFrame& frame) {
  const auto farthest_kept = detected.begin() + static_cast<std::ptrdiff_t>(count) - 1;
  std::ranges::nth_element(detected, farthest_kept, {},
                           [&](const Circle& obstacle) { return robot_distance_m(obstacle, frame); });
  // Without robots, any obstacle may have been left out.
  return frame.robots().empty() ? 0 : std::max(0.0, robot_distance_m(*farthest_kept, frame));
}

}  // namespace

void set_obstacles(std::span<Circle> detected, msg::DetectionFrame& frame) {
  const std::size_t count = std::min<std::size_t>(detected.size(), msg::MAX_OBSTACLES);
  frame.obstacles_complete_within_m(detected.size() > count ? select_nearest(detected, count, frame)
                                                            : kCompleteEverywhere_m);
  for (std::size_t i = 0; i < count; ++i) {
    msg::ObstacleDetection& obstacle = frame.obstacles()[i];
    obstacle.x_m(detected[i].centre_m.x());
    obstacle.y_m(detected[i].centre_m.y());
    obstacle.radius_m(detected[i].radius_m);
  }
  frame.obstacle_count(static_cast<std::uint16_t>(count));
}

}  // namespace sidestep
