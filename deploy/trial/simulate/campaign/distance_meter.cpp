// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/distance_meter.hpp"

namespace sidestep {
namespace {

// Movements below this are position noise of resting robots.
constexpr double kMinStep_m = 0.01;

}  // namespace

void DistanceMeter::add(const msg::GroundTruth& truth) {
  const bool counts = time_from_ns(truth.valid_at_ns()) > since_;
  for (const msg::TrueRobotState& robot : truth.robots()) {
    const Vec2 position_m(robot.x_m(), robot.y_m());
    const auto [entry, is_new] = distances_.try_emplace(robot.robot(), RobotDistance{position_m});
    RobotDistance& distance = entry->second;
    const double step_m = (position_m - distance.last_m).norm();
    if (step_m < kMinStep_m) continue;
    distance.last_m = position_m;
    distance.total_m += step_m;
    if (counts) distance.since_m += step_m;
  }
}

double DistanceMeter::total_m() const {
  double sum = 0;
  for (const auto& [robot, distance] : distances_) sum += distance.total_m;
  return sum;
}

double DistanceMeter::recent_total_m() const {
  double sum = 0;
  for (const auto& [robot, distance] : distances_) sum += distance.since_m;
  return sum;
}

std::vector<RobotId> DistanceMeter::stationary_robots(double min_distance_m) const {
  std::vector<RobotId> robots;
  for (const auto& [robot, distance] : distances_) {
    if (distance.since_m < min_distance_m) robots.push_back(robot);
  }
  return robots;
}

}  // namespace sidestep
