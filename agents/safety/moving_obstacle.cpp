// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/moving_obstacle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "agents/safety/creeping.hpp"

namespace sidestep {
namespace {

// Larger than the rounding errors of distances of a few metres.
constexpr double kRounding_m = 1e-9;
// A phase that is still undecided after this many halvings counts as unsafe.
constexpr int kMaxHalvings = 24;

/// Bernstein coefficients of a quartic on [0, 1]. The quartic lies within their range, starts at the first
/// and ends at the last.
using Quartic = std::array<double, 5>;

bool is_positive(const Quartic& q, int halvings) {
  if (q.front() <= 0 || q.back() <= 0) return false;
  if (std::ranges::all_of(q, [](double c) { return c > 0; })) return true;
  if (halvings == kMaxHalvings) return false;
  // De Casteljau's algorithm, in place.
  Quartic left, right = q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    left[i] = right[0];
    for (std::size_t k = 0; k + 1 + i < q.size(); ++k) right[k] = 0.5 * (right[k] + right[k + 1]);
  }
  return is_positive(left, halvings + 1) && is_positive(right, halvings + 1);
}

/// The squared distance minus the squared reach over a phase in which the reach grows linearly from `reach0`
/// to `reach1`.
Quartic squared_gap(const Vec2& from, const Vec2& velocity, const Vec2& acceleration, double seconds,
                    double reach0, double reach1) {
  const Vec2& b0 = from;
  const Vec2 b1 = from + 0.5 * seconds * velocity,
             b2 = from + seconds * (velocity + 0.5 * seconds * acceleration);
  const double r00 = reach0 * reach0, r01 = reach0 * reach1, r11 = reach1 * reach1;
  return {b0.dot(b0) - r00, b0.dot(b1) - (r00 + r01) / 2,
          (b0.dot(b2) + 2 * b1.dot(b1)) / 3 - (r00 + 4 * r01 + r11) / 6, b1.dot(b2) - (r01 + r11) / 2,
          b2.dot(b2) - r11};
}

}  // namespace

double MovingObstacle::reach_m(Time t) const {
  return radius_m + speed_mps * std::abs(to_seconds(t - observed_at));
}

bool is_passively_safe(const Trajectory& trajectory, const MovingObstacle& obstacle,
                       double min_separation_m) {
  const double separation = min_separation_m + kRounding_m;
  const double max_distance =
      sidestep::reach_m(trajectory) + separation +
      std::max(obstacle.reach_m(trajectory.start()), obstacle.reach_m(trajectory.end()));
  State state = trajectory.at_start();
  if ((state.position_m - obstacle.position_m).squaredNorm() > max_distance * max_distance) return true;
  Time t = trajectory.start();
  for (const MotionPhase& phase : trajectory.phases()) {
    if (phase.duration <= Duration::zero()) continue;
    const double seconds = to_seconds(phase.duration);
    // The reach is a convex function of time, so linear interpolation between its end values is an upper
    // bound.
    const double reach0 = separation + obstacle.reach_m(t),
                 reach1 = separation + obstacle.reach_m(t + phase.duration);
    const Quartic quartic = squared_gap(state.position_m - obstacle.position_m, state.velocity_mps,
                                        phase.acceleration_mps2, seconds, reach0, reach1);
    if (!is_positive(quartic, 0)) return false;
    state = state_after(state, phase.acceleration_mps2, seconds);
    t += phase.duration;
  }
  return true;
}

bool is_passively_safe_from_all(const Trajectory& trajectory, std::span<const MovingObstacle> obstacles,
                                double min_separation_m, double creep_mps) {
  return std::ranges::all_of(obstacles, [&](const MovingObstacle& obstacle) {
    const auto distance_m = [&](const Vec2& p) { return (p - obstacle.position_m).norm(); };
    return is_passively_safe(trajectory, obstacle, min_separation_m) ||
           creeps_away(trajectory, creep_mps, distance_m);
  });
}

}  // namespace sidestep
