// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/hidden_space.hpp"

#include <algorithm>
#include <cmath>

#include "agents/safety/creeping.hpp"

namespace sidestep {
namespace {

constexpr double kRounding_m = 1e-9;
/// Minimum bulge of a closed gap, unless its bulge is 0 because no person who protrudes through it can touch
/// a robot.
constexpr double kTouching_m = 1e-6;
/// A trajectory within this distance of being unsafe counts as unsafe.
constexpr double kTolerance_m = 1e-3;

/// The minimum over segments of the distance minus the bulge, at most `limit_m`. Segments with a bulge
/// smaller than `min_bulge_m` are ignored.
double nearest_m(const Vec2& p, std::span<const Frontier> frontiers, double min_bulge_m, double limit_m) {
  for (const Frontier& frontier : frontiers) {
    const double within_m = limit_m + frontier.bulge_m;
    if (frontier.bulge_m < min_bulge_m || within_m <= 0) continue;
    const double distance2 = squared_distance(p, frontier.segment);
    if (distance2 < within_m * within_m) limit_m = std::sqrt(distance2) - frontier.bulge_m;
  }
  return limit_m;
}

}  // namespace

double HiddenSpace::distance_m(const Vec2& p, Time t) const {
  constexpr double kFar_m = 1e6;
  const double growth_m = speed_mps * std::abs(to_seconds(t - observed_at));
  const double turned_m = heading_error_rad * (p - observed_from_m).norm();
  const double open_m = nearest_m(p, frontiers, 0, kFar_m) - growth_m;
  return nearest_m(p, closed_gaps, kTouching_m, open_m) - turned_m;
}

bool is_passively_safe_from_hidden(const Trajectory& trajectory, const HiddenSpace& hidden,
                                   double min_separation_m) {
  const auto distance_m = [&](const Vec2& p) { return hidden.distance_m(p, trajectory.start()); };
  if (hidden.is_nothing() || creeps_away(trajectory, hidden.creep_mps, distance_m)) return true;
  Time t = trajectory.start();
  State state = trajectory.at_start();
  const double separation_m = min_separation_m + kRounding_m;
  for (const MotionPhase& phase : trajectory.phases()) {
    if (phase.duration <= Duration::zero()) continue;
    const double seconds = to_seconds(phase.duration);
    const State end = state_after(state, phase.acceleration_mps2, seconds);
    // The speed is a convex function of time.
    const double closing_mps =
        (1 + hidden.heading_error_rad) * std::max(state.velocity_mps.norm(), end.velocity_mps.norm()) +
        hidden.speed_mps;
    double at_s = 0;
    while (true) {
      const State here = state_after(state, phase.acceleration_mps2, std::min(at_s, seconds));
      const Time then = t + from_seconds(std::min(at_s, seconds));
      const double room_m = hidden.distance_m(here.position_m, then) - separation_m;
      if (!(room_m > kTolerance_m)) return false;
      if (at_s >= seconds) break;
      at_s += room_m / closing_mps;
    }
    state = end;
    t += phase.duration;
  }
  return true;
}

}  // namespace sidestep
