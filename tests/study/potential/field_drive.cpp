// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/field_drive.hpp"

#include <algorithm>

#include "common/motion/robot_model.hpp"
#include "common/motion/trajectory.hpp"
#include "tests/study/potential/reversal_counter.hpp"

namespace sidestep {
namespace {

constexpr MotionLimits kDriveLimits{.speed_mps = 0.5};
constexpr double kDriveCycle_s = 1.0 / 60;
constexpr double kDriveArrival_m = 0.05;  ///< distance from the goal that counts as arrived
constexpr double kDriveTimeLimit_s = 60;
constexpr double kStuck_m = 0.1;       ///< a robot that moves by less than this ...
constexpr double kStuck_s = 4;         ///< ... in this time is in a local minimum
constexpr double kReversal_rad = 0.2;  ///< see ReversalCounter

bool is_stuck(const std::vector<Vec2>& path_m) {
  const auto cycles = static_cast<std::size_t>(kStuck_s / kDriveCycle_s);
  if (path_m.size() <= cycles) return false;
  const Vec2& now = path_m.back();
  return std::all_of(path_m.end() - static_cast<std::ptrdiff_t>(cycles), path_m.end(),
                     [&](const Vec2& p) { return (p - now).norm() < kStuck_m; });
}

}  // namespace

FieldDrive drive_by_direction(const DriveDirection& direction, const PlanWorld& world,
                              const ObstacleWorld& obstacles) {
  const PlanQuery& query = world.queries.front();
  State state{query.start_m, Vec2::Zero()};
  FieldDrive drive;
  drive.path_m = {state.position_m};
  ReversalCounter reversals(kReversal_rad);
  reversals.add(state.position_m);
  const auto has_ended = [&] {
    const Vec2& now = drive.path_m.back();
    if ((query.goal_m - now).norm() <= kDriveArrival_m)
      drive.end = DriveEnd::kArrived;
    else if (obstacles.touches(
                 drive.path_m[drive.path_m.size() - std::min<std::size_t>(2, drive.path_m.size())], now,
                 world.radius_m))
      drive.end = DriveEnd::kContact;
    else if (is_stuck(drive.path_m))
      drive.end = DriveEnd::kLocalMinimum;
    else
      return drive.seconds >= kDriveTimeLimit_s;
    return true;
  };
  while (!has_ended()) {
    // Plans the stop with half of the deceleration, so that the robot can turn meanwhile.
    const double left_m = (query.goal_m - state.position_m).norm();
    const double speed = std::min(kDriveLimits.speed_mps, std::sqrt(kDriveLimits.deceleration_mps2 * left_m));
    const Vec2 change = speed * direction(state.position_m) - state.velocity_mps;
    const Vec2 acceleration = limit_acceleration(change / kDriveCycle_s, state.velocity_mps, kDriveLimits,
                                                 from_seconds(kDriveCycle_s));
    state = state_after(state, acceleration, kDriveCycle_s);
    drive.seconds += kDriveCycle_s;
    drive.path_m.push_back(state.position_m);
    reversals.add(state.position_m);
  }
  drive.length_m = reversals.length_m();
  drive.reversals = reversals.reversals();
  return drive;
}

}  // namespace sidestep
