// SPDX-License-Identifier: Apache-2.0
#include "common/motion/validity.hpp"

#include <algorithm>
#include <cmath>

#include "common/motion/clearance.hpp"
#include "common/motion/rest.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

constexpr double kSpeedTolerance_mps = 1e-6;
constexpr double kAccelerationTolerance_mps2 = 1e-3;
// Agent and coordinator compute a continuation with the same function; the tolerance (m, m/s) covers machines
// that round differently.
constexpr double kContinuityTolerance = 1e-9;

/// The maximum |x| of one axis over a phase: at its ends, or where the velocity changes sign.
double max_excursion(double x, double v, double a, double seconds) {
  double max = std::max(std::abs(x), std::abs(x + seconds * (v + 0.5 * seconds * a)));
  if (a != 0) {
    const double turn = -v / a;
    if (turn > 0 && turn < seconds) max = std::max(max, std::abs(x + 0.5 * turn * v));
  }
  return max;
}

}  // namespace

Validity check_limits(const Trajectory& trajectory, const MotionLimits& limits) {
  State state = trajectory.at_start();
  const double max_speed_mps = limits.speed_mps + kSpeedTolerance_mps;
  if (!(state.velocity_mps.norm() <= max_speed_mps)) return Validity::kBeyondLimits;
  for (const MotionPhase& phase : trajectory.phases()) {
    const Vec2& a = phase.acceleration_mps2;
    const double max_mps2 = std::max(limits.acceleration_mps2, limits.deceleration_mps2);
    if (!(a.norm() <= max_mps2 + kAccelerationTolerance_mps2)) return Validity::kBeyondLimits;
    if (phase.duration > Duration::zero() &&
        !stays_admissible(a, state.velocity_mps, limits, phase.duration)) {
      return Validity::kBeyondLimits;
    }
    state = state_after(state, a, to_seconds(phase.duration));
    // The speed is a convex function of time over a phase, so its maximum is at one of the ends.
    if (!(state.velocity_mps.norm() <= max_speed_mps)) return Validity::kBeyondLimits;
  }
  return state.velocity_mps.norm() <= kPlannedRest_mps ? Validity::kValid : Validity::kNotAtRest;
}

Validity check_workspace(const Trajectory& trajectory, const FloorRules& rules) {
  if (!stays_on(rules.field, rules.radius_m, trajectory)) return Validity::kOutsideField;
  const double min_separation_m = rules.radius_m + rules.margin_m;
  const bool is_clear_of_all = std::ranges::all_of(rules.obstacles, [&](const Shape& obstacle) {
    return is_clear(trajectory, obstacle, min_separation_m);
  });
  if (!is_clear_of_all) return Validity::kObstacle;
  const bool is_clear_of_map = !rules.map || is_clear(trajectory, *rules.map, min_separation_m);
  return is_clear_of_map ? Validity::kValid : Validity::kObstacle;
}

bool stays_on(const Field& field, double radius_m, const Trajectory& trajectory) {
  const double max_x = field.length_m / 2 - radius_m, max_y = field.width_m / 2 - radius_m;
  State state = trajectory.at_start();
  if (!(std::abs(state.position_m.x()) <= max_x && std::abs(state.position_m.y()) <= max_y)) return false;
  for (const MotionPhase& phase : trajectory.phases()) {
    const double seconds = to_seconds(phase.duration);
    const Vec2 &p = state.position_m, &v = state.velocity_mps, &a = phase.acceleration_mps2;
    if (!(max_excursion(p.x(), v.x(), a.x(), seconds) <= max_x)) return false;
    if (!(max_excursion(p.y(), v.y(), a.y(), seconds) <= max_y)) return false;
    state = state_after(state, a, seconds);
  }
  return true;
}

bool continues(const Trajectory& trajectory, const Trajectory& base) {
  if (trajectory.start() <= base.start()) return false;
  const State expected = base.state_at(trajectory.start());
  return (trajectory.at_start().position_m - expected.position_m).norm() <= kContinuityTolerance &&
         (trajectory.at_start().velocity_mps - expected.velocity_mps).norm() <= kContinuityTolerance;
}

}  // namespace sidestep
