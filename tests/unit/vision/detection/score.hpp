// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "idl/vision.hpp"
#include "tests/unit/vision/patterns/placed_robots.hpp"

namespace sidestep::test {

/// Recognition rate and errors over a number of frames.
struct Score {
  std::size_t visible = 0, found = 0, wrong = 0;
  double position2_m2 = 0, heading2_rad2 = 0;

  void add(const std::vector<PlacedRobot>& robots, const msg::DetectionFrame& frame) {
    visible += robots.size();
    for (const msg::RobotDetection& detection : frame.robots()) {
      const auto truth = std::ranges::find_if(
          robots, [&](const PlacedRobot& robot) { return robot.entry.robot == detection.robot(); });
      const Vec2 error = truth->pose.position_m - Vec2(detection.x_m(), detection.y_m());
      if (error.norm() > 0.03) {
        ++wrong;
        continue;
      }
      ++found;
      position2_m2 += error.squaredNorm();
      heading2_rad2 += std::pow(wrapped_rad(detection.heading_rad() - truth->pose.heading_rad), 2);
    }
  }
  double share() const { return static_cast<double>(found) / static_cast<double>(visible); }
  double position_m() const { return std::sqrt(position2_m2 / static_cast<double>(found)); }
  double heading_rad() const { return std::sqrt(heading2_rad2 / static_cast<double>(found)); }
};

}  // namespace sidestep::test
