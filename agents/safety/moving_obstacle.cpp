// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/moving_obstacle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sidestep {
namespace {

// Far above what rounding does to distances of a few metres.
constexpr double kRounding_m = 1e-9;
// After so many halvings of a phase what is left undecided is decided against.
constexpr int kMostHalvings = 24;

/// A quartic on [0, 1] by its Bernstein coefficients: it lies within their range, and begins and ends at the
/// first and the last.
using Quartic = std::array<double, 5>;

bool is_positive(const Quartic& q, int halvings) {
  if (q.front() <= 0 || q.back() <= 0) return false;
  if (std::ranges::all_of(q, [](double c) { return c > 0; })) return true;
  if (halvings == kMostHalvings) return false;
  // De Casteljau.
  Quartic left, right = q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    left[i] = right[0];
    for (std::size_t k = 0; k + 1 + i < q.size(); ++k) right[k] = 0.5 * (right[k] + right[k + 1]);
  }
  // What is left of each row is its last element, in place.
  return is_positive(left, halvings + 1) && is_positive(right, halvings + 1);
}

/// The squared distance less the squared reach over a phase; the reach grows from `reach0` to `reach1`.
Quartic gap(const Vec2& from, const Vec2& velocity, const Vec2& acceleration, double seconds, double reach0,
            double reach1) {
  const Vec2 b0 = from, b1 = from + 0.5 * seconds * velocity,
             b2 = from + seconds * (velocity + 0.5 * seconds * acceleration);
  const double r00 = reach0 * reach0, r01 = reach0 * reach1, r11 = reach1 * reach1;
  return {b0.dot(b0) - r00, b0.dot(b1) - (r00 + r01) / 2,
          (b0.dot(b2) + 2 * b1.dot(b1)) / 3 - (r00 + 4 * r01 + r11) / 6, b1.dot(b2) - (r01 + r11) / 2,
          b2.dot(b2) - r11};
}

}  // namespace

double MovingObstacle::reach_m(Time t) const {
  return radius_m + speed_mps * std::abs(to_seconds(t - seen_at));
}

bool rests_before(const Trajectory& trajectory, const MovingObstacle& obstacle, double min_separation_m) {
  const double keep = min_separation_m + kRounding_m;
  const double far = sidestep::reach_m(trajectory) + keep +
                     std::max(obstacle.reach_m(trajectory.start()), obstacle.reach_m(trajectory.end()));
  State state = trajectory.at_start();
  if ((state.position_m - obstacle.position_m).squaredNorm() > far * far) return true;
  Time t = trajectory.start();
  for (const MotionPhase& phase : trajectory.phases()) {
    if (phase.duration <= Duration::zero()) continue;
    const double seconds = to_seconds(phase.duration);
    // The reach is convex in time, so it lies below what grows evenly between its ends.
    const double reach0 = keep + obstacle.reach_m(t), reach1 = keep + obstacle.reach_m(t + phase.duration);
    const Quartic quartic = gap(state.position_m - obstacle.position_m, state.velocity_mps,
                                phase.acceleration_mps2, seconds, reach0, reach1);
    if (!is_positive(quartic, 0)) return false;
    state = state_after(state, phase.acceleration_mps2, seconds);
    t += phase.duration;
  }
  return true;
}

bool rests_before_all(const Trajectory& trajectory, std::span<const MovingObstacle> obstacles,
                      double min_separation_m) {
  return std::ranges::all_of(
      obstacles, [&](const MovingObstacle& obstacle) { return rests_before(trajectory, obstacle, min_separation_m); });
}

}  // namespace sidestep
