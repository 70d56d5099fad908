// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/trajectory.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

inline Vec2 random_vector(Rng& rng, double max) { return {rng.uniform(-max, max), rng.uniform(-max, max)}; }

/// At most `max_angle_rad` from the direction of the x axis.
inline Vec2 random_velocity(Rng& rng, double max_mps, double max_angle_rad) {
  const Vec2 direction = rotated({1, 0}, rng.uniform(-max_angle_rad, max_angle_rad));
  return rng.uniform(0, max_mps) * direction;
}

/// Up to three random phases and a stop, near the origin. The start is within 0.5 s of `around`.
inline Trajectory random_trajectory(Rng& rng, Time around = time_from_ns(1'000'000'000)) {
  const Vec2 position = random_vector(rng, 0.6);
  const Vec2 velocity = rng.chance(0.1) ? Vec2(0, 0) : random_vector(rng, 2);
  Trajectory trajectory(around + from_seconds(rng.uniform(-0.5, 0.5)), {position, velocity});
  const auto phases = rng.below(4);
  for (std::uint64_t i = 0; i < phases; ++i) {
    const Duration duration = rng.chance(0.05) ? Duration{static_cast<std::int64_t>(rng.below(3))}
                                               : from_seconds(rng.uniform(0, 0.4));
    trajectory.append(duration, rng.chance(0.1) ? Vec2(0, 0) : random_vector(rng, 5));
  }
  append_stop(trajectory, rng.uniform(3, 6));
  return trajectory;
}

inline double distance_at(const Trajectory& a, const Trajectory& b, Time t) {
  return (a.state_at(t).position_m - b.state_at(t).position_m).norm();
}

}  // namespace sidestep
