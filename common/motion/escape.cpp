// SPDX-License-Identifier: Apache-2.0
#include "common/motion/escape.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"

namespace sidestep {
namespace {

/// The maximum |x| and |y| along a trajectory.
Vec2 max_extent_m(const Trajectory& trajectory) {
  State state = trajectory.at_start();
  Vec2 extent = state.position_m.cwiseAbs();
  for (const MotionPhase& phase : trajectory.phases()) {
    const double seconds = to_seconds(phase.duration);
    for (const int axis : {0, 1}) {
      const double turn = -state.velocity_mps[axis] / phase.acceleration_mps2[axis];
      if (!(turn > 0 && turn < seconds)) continue;  // also skips zero acceleration
      const double turning_point = state.position_m[axis] + 0.5 * turn * state.velocity_mps[axis];
      extent[axis] = std::max(extent[axis], std::abs(turning_point));
    }
    state = state_after(state, phase.acceleration_mps2, seconds);
    extent = extent.cwiseMax(state.position_m.cwiseAbs());
  }
  return extent;
}

}  // namespace

Trajectory remaining_trajectory(const Trajectory& trajectory, Time from) {
  if (from <= trajectory.start()) return trajectory;
  Trajectory remaining(from, trajectory.state_at(from));
  Time begin = trajectory.start();
  for (const MotionPhase& phase : trajectory.phases()) {
    const Time end = begin + phase.duration;
    if (end > from) remaining.append(end - std::max(begin, from), phase.acceleration_mps2);
    begin = end;
  }
  return remaining;
}

double relaxed_separation_m(const Trajectory& base, Time from, const Trajectory& other,
                            double min_separation_m) {
  return std::min(min_separation_m,
                  clearance_m(remaining_trajectory(base, from), other, 0) - kClearanceTolerance_m);
}

Validity check_workspace_with_escape(const Version& version, const Trajectory& base,
                                     const FloorRules& rules) {
  FloorRules relaxed = rules;
  relaxed.margin_m += version.inflation_m;
  const Validity validity = check_workspace(version.trajectory, version.inflation_m == 0 ? rules : relaxed);
  if (validity == Validity::kValid) return validity;
  const Trajectory remaining = remaining_trajectory(base, version.trajectory.start());
  const double edge_distance_m = rules.radius_m + kClearanceTolerance_m;
  const Vec2 extent = max_extent_m(remaining);
  relaxed.field.length_m = std::max(relaxed.field.length_m, 2 * (extent.x() + edge_distance_m));
  relaxed.field.width_m = std::max(relaxed.field.width_m, 2 * (extent.y() + edge_distance_m));
  const double min_separation_m = relaxed.radius_m + relaxed.margin_m;
  if (!stays_on(relaxed.field, relaxed.radius_m, version.trajectory)) return Validity::kOutsideField;
  const auto is_clear_of = [&](const Shape& obstacle) {
    const double base_m = clearance_m(remaining, obstacle, 0) - kClearanceTolerance_m;
    return is_clear(version.trajectory, obstacle, std::min(min_separation_m, base_m));
  };
  if (!std::ranges::all_of(rules.obstacles, is_clear_of)) return Validity::kObstacle;
  const bool is_clear_of_map =
      !rules.map || for_each_near_box(version.trajectory, *rules.map, min_separation_m,
                                      [&](const Box& box) { return is_clear_of(box); });
  return is_clear_of_map ? Validity::kValid : Validity::kObstacle;
}

}  // namespace sidestep
