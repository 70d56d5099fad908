// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/motion_meter.hpp"

namespace sidestep {
namespace {

// What robots that hold their place shake is not counted.
constexpr double kShake_m = 0.01;

}  // namespace

void MotionMeter::add(const msg::GroundTruth& truth) {
  const bool counts = time_from_ns(truth.at_ns()) > since_;
  for (const msg::TruthRobot& robot : truth.robots()) {
    const Vec2 here(robot.x_m(), robot.y_m());
    const auto [entry, is_new] = ways_.try_emplace(robot.robot(), Way{here});
    Way& way = entry->second;
    const double step_m = (here - way.last_m).norm();
    if (step_m < kShake_m) continue;
    way.last_m = here;
    way.total_m += step_m;
    if (counts) way.since_m += step_m;
  }
}

double MotionMeter::total_m() const {
  double sum = 0;
  for (const auto& [robot, way] : ways_) sum += way.total_m;
  return sum;
}

double MotionMeter::total_since_m() const {
  double sum = 0;
  for (const auto& [robot, way] : ways_) sum += way.since_m;
  return sum;
}

std::vector<RobotId> MotionMeter::still(double less_m) const {
  std::vector<RobotId> robots;
  for (const auto& [robot, way] : ways_) {
    if (way.since_m < less_m) robots.push_back(robot);
  }
  return robots;
}

}  // namespace sidestep
