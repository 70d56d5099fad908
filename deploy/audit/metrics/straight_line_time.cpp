// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/straight_line_time.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

double straight_line_time_s(const RobotSpec& robot, const MotionLimits& limits) {
  const double s2_per_m = 1 / limits.acceleration_mps2 + 1 / limits.deceleration_mps2;
  Vec2 from_m = robot.start_m;
  double total_s = 0;
  for (const Goal& goal : robot.goals) {
    const double max_mps = limits_to(goal, limits).speed_mps;
    const double distance_m = (goal.position_m - from_m).norm();
    const double peak_mps = std::min(max_mps, std::sqrt(2 * distance_m / s2_per_m));
    const double ramps_m = peak_mps * peak_mps * s2_per_m / 2;
    total_s += peak_mps * s2_per_m + std::max(0.0, distance_m - ramps_m) / max_mps;
    from_m = goal.position_m;
  }
  return total_s;
}

std::optional<double> straight_line_time_ratio(std::span<const RobotSpec> robots,
                                               std::span<const std::optional<double>> arrivals_s,
                                               const MotionLimits& limits) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!arrivals_s[i]) continue;
    const double straight_s = straight_line_time_s(robots[i], limits);
    if (straight_s <= 0) continue;
    sum += *arrivals_s[i] / straight_s;
    ++count;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace sidestep
