// SPDX-License-Identifier: Apache-2.0
#include "common/motion/robot_model.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

// Slower than this there is no ahead and behind.
constexpr double kAtRest_mps = 1e-6;

double squared(double x) { return x * x; }

// The square of the norm whose unit ball is A(v): 1 on its edge. The batch kernels compute the same,
// operation by operation (batch::Kernels::limit).
double effort2(const Vec2& a, const Vec2& v, const MotionLimits& limits) {
  const double sideways_and_ahead2 =
      (a.x() * a.x() + a.y() * a.y()) * (1 / squared(limits.acceleration_mps2));
  const double speed = v.norm();
  if (speed < kAtRest_mps) return sideways_and_ahead2;
  const double along = (a.x() * v.x() + a.y() * v.y()) * (1 / speed);
  if (along >= 0) return sideways_and_ahead2;
  const double across = (v.x() * a.y() - v.y() * a.x()) * (1 / speed);
  return along * along * (1 / squared(limits.deceleration_mps2)) +
         across * across * (1 / squared(limits.acceleration_mps2));
}

}  // namespace

bool is_admissible(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits) {
  return effort2(acceleration, velocity, limits) <= squared(1 + 1e-6);
}

Vec2 scaled_into_model(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits) {
  const double e2 = effort2(acceleration, velocity, limits);
  return e2 > 1 ? Vec2(acceleration * (1 / std::sqrt(e2))) : acceleration;
}

Vec2 limited(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits, Duration duration) {
  const double seconds = to_seconds(duration);
  const Vec2 after = velocity + seconds * acceleration;
  const double speed2 = after.x() * after.x() + after.y() * after.y();
  if (speed2 <= squared(limits.speed_mps)) return scaled_into_model(acceleration, velocity, limits);
  // Scaling towards zero afterwards stays within the speed limit, because both ends of the scale are within
  // it.
  const Vec2 slowed = (after * (limits.speed_mps / std::sqrt(speed2)) - velocity) * (1 / seconds);
  return scaled_into_model(slowed, velocity, limits);
}

Vec2 sample(const Vec2& velocity, const MotionLimits& limits, Rng& rng) {
  const double speed = velocity.norm();
  const Vec2 local = sample_ahead(speed < kAtRest_mps, limits, rng);
  const Vec2 forward = forward_of(velocity);
  return {local.x() * forward.x() - local.y() * forward.y(),
          local.x() * forward.y() + local.y() * forward.x()};
}

Vec2 sample_ahead(bool is_at_rest, const MotionLimits& limits, Rng& rng) {
  double x, y;
  sample_ahead(is_at_rest, limits, rng, 1, &x, &y);
  return {x, y};
}

// From the rectangle about the set, until one lies within: it fills pi / 4 of it. What does not is written
// over, which costs less than branches that nobody can predict.
void sample_ahead(bool is_at_rest, const MotionLimits& limits, Rng& rng, std::size_t count, double* x,
                  double* y) {
  const double ahead = limits.acceleration_mps2, aside = limits.acceleration_mps2;
  const double behind = is_at_rest ? ahead : limits.deceleration_mps2;
  const double whole = (ahead + behind) * 0x1.0p-32, per_ahead = 1 / ahead, per_behind = 1 / behind;
  for (std::size_t i = 0; i < count;) {
    const std::uint64_t bits = rng.bits();
    const double along = static_cast<double>(static_cast<std::int64_t>(bits >> 32)) * whole - behind;
    const double across = static_cast<double>(static_cast<std::int64_t>(bits & 0xffffffff)) * 0x1.0p-31 - 1;
    const double part = std::max(along * per_ahead, -along * per_behind);
    x[i] = along;
    y[i] = aside * across;
    i += part * part + across * across <= 1 ? 1 : 0;
  }
}

Vec2 forward_of(const Vec2& velocity) {
  const double speed = velocity.norm();
  return speed < kAtRest_mps ? Vec2(1, 0) : Vec2(velocity * (1 / speed));
}

batch::LimitSettings limit_settings(const Vec2& velocity, const Vec2& desired, const MotionLimits& limits,
                                    Duration duration) {
  const double speed = velocity.norm(), seconds = to_seconds(duration);
  const Vec2 forward = forward_of(velocity);
  return {forward.x(),
          forward.y(),
          velocity.x(),
          velocity.y(),
          speed < kAtRest_mps,
          1 / squared(limits.acceleration_mps2),
          1 / squared(limits.deceleration_mps2),
          speed < kAtRest_mps ? 0 : 1 / speed,
          limits.speed_mps,
          seconds,
          1 / seconds,
          desired.x(),
          desired.y()};
}

}  // namespace sidestep
