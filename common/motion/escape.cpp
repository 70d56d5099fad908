// SPDX-License-Identifier: Apache-2.0
#include "common/motion/escape.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"

namespace sidestep {
namespace {

/// The largest |x| and |y| that a trajectory gets to.
Vec2 farthest_m(const Trajectory& trajectory) {
  State state = trajectory.at_start();
  Vec2 farthest = state.position_m.cwiseAbs();
  for (const MotionPhase& phase : trajectory.phases()) {
    const double seconds = to_seconds(phase.duration);
    for (const int axis : {0, 1}) {
      const double turn = -state.velocity_mps[axis] / phase.acceleration_mps2[axis];
      if (!(turn > 0 && turn < seconds)) continue;  // nor where the acceleration is zero
      const double there = state.position_m[axis] + 0.5 * turn * state.velocity_mps[axis];
      farthest[axis] = std::max(farthest[axis], std::abs(there));
    }
    state = state_after(state, phase.acceleration_mps2, seconds);
    farthest = farthest.cwiseMax(state.position_m.cwiseAbs());
  }
  return farthest;
}

}  // namespace

Trajectory rest_of(const Trajectory& trajectory, Time from) {
  if (from <= trajectory.start()) return trajectory;
  Trajectory rest(from, trajectory.state_at(from));
  Time begin = trajectory.start();
  for (const MotionPhase& phase : trajectory.phases()) {
    const Time end = begin + phase.duration;
    if (end > from) rest.append(end - std::max(begin, from), phase.acceleration_mps2);
    begin = end;
  }
  return rest;
}

double kept_distance_m(const Trajectory& base, Time from, const Trajectory& other, double min_separation_m) {
  return std::min(min_separation_m, clearance_m(rest_of(base, from), other, 0) - kClearanceTolerance_m);
}

msg::Reason check_place_after(const Version& version, const Trajectory& base, const FloorRules& rules) {
  FloorRules eased = rules;
  eased.margin_m += version.inflation_m;
  const msg::Reason reason = check_place(version.trajectory, version.inflation_m == 0 ? rules : eased);
  if (reason == msg::REASON_GRANTED) return reason;
  const Trajectory rest = rest_of(base, version.trajectory.start());
  const double extra_clearance_m = rules.radius_m + kClearanceTolerance_m;
  const Vec2 farthest = farthest_m(rest);
  eased.field.length_m = std::max(eased.field.length_m, 2 * (farthest.x() + extra_clearance_m));
  eased.field.width_m = std::max(eased.field.width_m, 2 * (farthest.y() + extra_clearance_m));
  const double min_separation_m = eased.radius_m + eased.margin_m;
  for (Circle& obstacle : eased.obstacles) {
    const double kept_m = kept_distance_m(
        rest, rest.start(), Trajectory::resting(rest.start(), obstacle.centre_m), min_separation_m + obstacle.radius_m);
    obstacle.radius_m = kept_m - min_separation_m;
  }
  return check_place(version.trajectory, eased);
}

}  // namespace sidestep
