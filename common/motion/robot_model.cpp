// SPDX-License-Identifier: Apache-2.0
#include "common/motion/robot_model.hpp"

#include <cmath>

namespace sidestep {
namespace {

// Slower than this there is no ahead and behind.
constexpr double kAtRest_mps = 1e-6;

// The norm whose unit ball is A(v): 1 on its edge.
double effort(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits) {
  const double speed = velocity.norm();
  const double sideways_and_ahead = acceleration.norm() / limits.acceleration_mps2;
  if (speed < kAtRest_mps) return sideways_and_ahead;
  const double ahead = acceleration.dot(velocity) / speed;
  if (ahead >= 0) return sideways_and_ahead;
  const double across = cross(velocity, acceleration) / speed;
  return std::hypot(ahead / limits.deceleration_mps2, across / limits.acceleration_mps2);
}

}  // namespace

bool is_admissible(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits) {
  return effort(acceleration, velocity, limits) <= 1 + 1e-6;
}

Vec2 scaled_into_model(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits) {
  const double e = effort(acceleration, velocity, limits);
  return e > 1 ? Vec2(acceleration / e) : acceleration;
}

Vec2 limited(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits, Duration duration) {
  const double seconds = to_seconds(duration);
  const Vec2 after = velocity + seconds * acceleration;
  const double speed = after.norm();
  if (speed <= limits.speed_mps) return scaled_into_model(acceleration, velocity, limits);
  // Scaling towards zero afterwards stays within the speed limit, because both ends of the scale are within
  // it.
  const Vec2 slowed = (after * (limits.speed_mps / speed) - velocity) / seconds;
  return scaled_into_model(slowed, velocity, limits);
}

Vec2 sample(const Vec2& velocity, const MotionLimits& limits, Rng& rng) {
  const double f = limits.acceleration_mps2, d = limits.deceleration_mps2;
  const double speed = velocity.norm();
  const double angle = 3.14159265358979323846 * rng.uniform() - 0.5 * 3.14159265358979323846;
  const double radius = std::sqrt(rng.uniform());
  // The two halves have areas in the ratio F to D (to F again for a robot at rest).
  const double behind = speed < kAtRest_mps ? f : d;
  const double ahead = rng.chance(f / (f + behind)) ? f : -behind;
  const Vec2 local(ahead * radius * std::cos(angle), f * radius * std::sin(angle));
  if (speed < kAtRest_mps) return local;
  const Vec2 forward = velocity / speed;
  return local.x() * forward + local.y() * left_of(forward);
}

}  // namespace sidestep
