// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/field_drive.hpp"

#include <algorithm>

#include "common/motion/robot_model.hpp"
#include "common/motion/trajectory.hpp"
#include "tests/study/potential/reversal_counter.hpp"

namespace sidestep {
namespace {

bool is_stuck(const std::vector<Vec2>& path_m, const FieldDriveSettings& settings) {
  const auto cycles = static_cast<std::size_t>(settings.stuck_s / settings.cycle_s);
  if (path_m.size() <= cycles) return false;
  const Vec2& now = path_m.back();
  return std::all_of(path_m.end() - static_cast<std::ptrdiff_t>(cycles), path_m.end(),
                     [&](const Vec2& p) { return (p - now).norm() < settings.stuck_m; });
}

}  // namespace

FieldDrive drive_by(const DriveDirection& direction, const PlanWorld& world, const ObstacleWorld& obstacles,
                    const FieldDriveSettings& settings) {
  const PlanQuery& query = world.queries.front();
  const MotionLimits& limits = settings.limits;
  State state{query.start_m, Vec2::Zero()};
  FieldDrive drive;
  drive.path_m = {state.position_m};
  ReversalCounter reversals(settings.reversal_rad);
  reversals.add(state.position_m);
  const auto has_ended = [&] {
    const Vec2& now = drive.path_m.back();
    if ((query.goal_m - now).norm() <= settings.arrival_m)
      drive.end = DriveEnd::kArrived;
    else if (obstacles.touches(
                 drive.path_m[drive.path_m.size() - std::min<std::size_t>(2, drive.path_m.size())], now,
                 world.radius_m))
      drive.end = DriveEnd::kContact;
    else if (is_stuck(drive.path_m, settings))
      drive.end = DriveEnd::kLocalMinimum;
    else
      return drive.seconds >= settings.time_limit_s;
    return true;
  };
  while (!has_ended()) {
    // Half the deceleration leaves some for turning.
    const double left_m = (query.goal_m - state.position_m).norm();
    const double speed = std::min(limits.speed_mps, std::sqrt(limits.deceleration_mps2 * left_m));
    const Vec2 change = speed * direction(state.position_m) - state.velocity_mps;
    const Vec2 acceleration = limit_acceleration(change / settings.cycle_s, state.velocity_mps, limits,
                                                 from_seconds(settings.cycle_s));
    state = state_after(state, acceleration, settings.cycle_s);
    drive.seconds += settings.cycle_s;
    drive.path_m.push_back(state.position_m);
    reversals.add(state.position_m);
  }
  drive.length_m = reversals.length_m();
  drive.reversals = reversals.reversals();
  return drive;
}

}  // namespace sidestep
