// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/seen_region.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

double SeenRegion::radius_at_m(Time t) const {
  return radius_m - speed_mps * std::abs(to_seconds(t - observed_at));
}

SeenRegion SeenRegion::limited_by(const SeenRegion& other) const {
  if (is_everywhere()) return other;
  SeenRegion limited = *this;
  if (!other.is_everywhere()) {
    const double distance = (centre_m - other.centre_m).norm();
    limited.radius_m = std::min(radius_m, other.radius_at_m(observed_at) - distance);
  }
  return limited;
}

bool is_passively_safe_from_unseen(const Trajectory& trajectory, const SeenRegion& seen,
                                   double min_separation_m) {
  if (seen.is_everywhere()) return true;
  constexpr double kRoundingErrors_m = 1e-9;
  const double separation = min_separation_m + kRoundingErrors_m;
  State state = trajectory.at_start();
  Time t = trajectory.start();
  for (const MotionPhase& phase : trajectory.phases()) {
    if (phase.duration <= Duration::zero()) continue;
    const double seconds = to_seconds(phase.duration);
    const State next = state_after(state, phase.acceleration_mps2, seconds);
    const Vec2 middle = state.position_m + 0.5 * seconds * state.velocity_mps;
    const double radius0 = seen.radius_at_m(t), radius1 = seen.radius_at_m(t + phase.duration);
    const auto is_inside = [&](const Vec2& control_point, double radius_m) {
      return (control_point - seen.centre_m).norm() + separation < radius_m;
    };
    if (!is_inside(state.position_m, radius0) || !is_inside(middle, 0.5 * (radius0 + radius1)) ||
        !is_inside(next.position_m, radius1))
      return false;
    state = next;
    t += phase.duration;
  }
  return true;
}

}  // namespace sidestep
