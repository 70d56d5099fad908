// SPDX-License-Identifier: Apache-2.0
#include "common/motion/validity.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

constexpr double kSpeedTolerance_mps = 1e-6;
constexpr double kAccelerationTolerance_mps2 = 1e-3;
// Both sides compute a continuation with the same function; this is for machines that round differently.
constexpr double kContinuity = 1e-9;

/// The largest |x| of one axis over a phase, beyond its ends: where the velocity changes sign.
double largest_excursion(double x, double v, double a, double seconds) {
  double largest = std::max(std::abs(x), std::abs(x + seconds * (v + 0.5 * seconds * a)));
  if (a != 0) {
    const double turn = -v / a;
    if (turn > 0 && turn < seconds) largest = std::max(largest, std::abs(x + 0.5 * turn * v));
  }
  return largest;
}

}  // namespace

FloorRules floor_rules(const Scenario& scenario) {
  return {scenario.field, scenario.obstacles, scenario.limits, scenario.radius_m, scenario.margin_m};
}

msg::Reason check_limits(const Trajectory& trajectory, const MotionLimits& limits) {
  State state = trajectory.at_start();
  if (state.velocity_mps.norm() > limits.speed_mps + kSpeedTolerance_mps) return msg::REASON_BEYOND_LIMITS;
  for (const MotionPhase& phase : trajectory.phases()) {
    const Vec2& a = phase.acceleration_mps2;
    const double largest = std::max(limits.acceleration_mps2, limits.deceleration_mps2);
    if (a.norm() > largest + kAccelerationTolerance_mps2) return msg::REASON_BEYOND_LIMITS;
    if (phase.duration > Duration::zero() && !is_admissible(a, state.velocity_mps, limits)) {
      return msg::REASON_BEYOND_LIMITS;
    }
    state = state_after(state, a, to_seconds(phase.duration));
    // The speed is convex over a phase, so its ends bound it.
    if (state.velocity_mps.norm() > limits.speed_mps + kSpeedTolerance_mps) return msg::REASON_BEYOND_LIMITS;
  }
  return state.velocity_mps.norm() <= kSpeedTolerance_mps ? msg::REASON_GRANTED : msg::REASON_NOT_AT_REST;
}

msg::Reason check_place(const Trajectory& trajectory, const FloorRules& rules) {
  if (!stays_on(rules.field, rules.radius_m, trajectory)) return msg::REASON_OUTSIDE_FIELD;
  const double reach = reach_m(trajectory);
  for (const Circle& obstacle : rules.obstacles) {
    const double keep = obstacle.radius_m + rules.radius_m + rules.margin_m;
    const double far = reach + keep + kClearanceTolerance_m;
    if ((obstacle.centre_m - trajectory.at_start().position_m).squaredNorm() > far * far) continue;
    if (!is_clear(trajectory, obstacle.centre_m, keep)) return msg::REASON_OBSTACLE;
  }
  return msg::REASON_GRANTED;
}

bool stays_on(const Field& field, double radius_m, const Trajectory& trajectory) {
  const double room_x = field.length_m / 2 - radius_m, room_y = field.width_m / 2 - radius_m;
  State state = trajectory.at_start();
  if (std::abs(state.position_m.x()) > room_x || std::abs(state.position_m.y()) > room_y) return false;
  for (const MotionPhase& phase : trajectory.phases()) {
    const double seconds = to_seconds(phase.duration);
    const Vec2 &p = state.position_m, &v = state.velocity_mps, &a = phase.acceleration_mps2;
    if (largest_excursion(p.x(), v.x(), a.x(), seconds) > room_x) return false;
    if (largest_excursion(p.y(), v.y(), a.y(), seconds) > room_y) return false;
    state = state_after(state, a, seconds);
  }
  return true;
}

bool continues(const Trajectory& trajectory, const Trajectory& base) {
  if (trajectory.start() <= base.start()) return false;
  const State there = base.state_at(trajectory.start());
  return (trajectory.at_start().position_m - there.position_m).norm() <= kContinuity &&
         (trajectory.at_start().velocity_mps - there.velocity_mps).norm() <= kContinuity;
}

}  // namespace sidestep
