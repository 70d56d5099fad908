// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/trapezoidal_profile.hpp"

#include <cmath>
#include <numbers>

namespace sidestep {

template <typename Add>
void TrapezoidalProfile::for_each_phase(double distance, double velocity, const MotionLimits& limits,
                                        Add add) {
  const auto append = [&](double seconds, double acceleration) {
    if (seconds > 0) add(seconds, acceleration);
  };
  const double accelerate = limits.acceleration_mps2, brake = limits.deceleration_mps2,
               max_speed = limits.speed_mps;
  // Mirrored so that the goal lies ahead of the point where an immediate stop would end.
  const double stop = velocity * std::abs(velocity) / (2 * brake);
  const double sign = distance >= stop ? 1 : -1;
  double d = sign * distance, v = sign * velocity;
  if (v < 0) {
    append(-v / brake, sign * brake);
    d += v * v / (2 * brake);
    v = 0;
  } else if (v > max_speed) {
    append((v - max_speed) / brake, -sign * brake);
    d -= (v * v - max_speed * max_speed) / (2 * brake);
    v = max_speed;
  }
  double peak = std::sqrt(
      std::max(0.0, 2 * accelerate * brake * (d + v * v / (2 * accelerate)) / (accelerate + brake)));
  double cruise_s = 0;
  if (peak > max_speed) {
    cruise_s =
        (d - (max_speed * max_speed - v * v) / (2 * accelerate) - max_speed * max_speed / (2 * brake)) /
        max_speed;
    peak = max_speed;
  }
  append((peak - v) / accelerate, sign * accelerate);
  append(cruise_s, 0);
  append(peak / brake, -sign * brake);
}

TrapezoidalProfile::TrapezoidalProfile(double distance, double velocity, const MotionLimits& limits)
    : velocity_(velocity) {
  for_each_phase(distance, velocity, limits, [this](double seconds, double acceleration) {
    phases_[static_cast<std::size_t>(count_++)] = {seconds, acceleration};
  });
}

double TrapezoidalProfile::duration_s(double distance, double velocity, const MotionLimits& limits) {
  double total = 0;
  for_each_phase(distance, velocity, limits, [&total](double seconds, double) { total += seconds; });
  return total;
}

double TrapezoidalProfile::duration_s() const {
  double total = 0;
  for (int i = 0; i < count_; ++i) total += phases_[static_cast<std::size_t>(i)].seconds;
  return total;
}

double TrapezoidalProfile::velocity_after(double seconds) const {
  double v = velocity_;
  for (int i = 0; i < count_; ++i) {
    const Phase& phase = phases_[static_cast<std::size_t>(i)];
    if (seconds <= phase.seconds) return v + seconds * phase.acceleration;
    v += phase.seconds * phase.acceleration;
    seconds -= phase.seconds;
  }
  return 0;
}

namespace {

MotionLimits scaled(const MotionLimits& limits, double fraction) {
  return {limits.acceleration_mps2 * fraction, limits.deceleration_mps2 * fraction,
          limits.speed_mps * fraction};
}

/// The angle whose cosine is the fraction of the limits for the axis along the displacement, and whose sine
/// is the fraction for the axis across it.
double balanced_angle_rad(double distance, double v_along, double v_across, const MotionLimits& limits) {
  double low = 0, high = std::abs(v_across) < 1e-6 ? 1e-3 : std::numbers::pi / 2;
  for (int i = 0; i < 20 && high - low > 1e-4; ++i) {
    const double angle = 0.5 * (low + high);
    const double along_s = TrapezoidalProfile::duration_s(distance, v_along, scaled(limits, std::cos(angle)));
    const double across_s = TrapezoidalProfile::duration_s(0, v_across, scaled(limits, std::sin(angle)));
    (along_s < across_s ? low : high) = angle;
  }
  return 0.5 * (low + high);
}

Vec2 direction_of(const Vec2& displacement, const Vec2& velocity) {
  if (displacement.norm() > 1e-9) return displacement.normalized();
  return velocity.norm() > 1e-9 ? Vec2(velocity.normalized()) : Vec2(1, 0);
}

}  // namespace

TrapezoidalProfile2d::TrapezoidalProfile2d(const Vec2& displacement, const Vec2& velocity,
                                           const MotionLimits& limits)
    : direction_(direction_of(displacement, velocity)), along_(0, 0, limits), across_(0, 0, limits) {
  const double distance = displacement.norm();
  const double v_along = velocity.dot(direction_), v_across = velocity.dot(left_of(direction_));
  const double angle = balanced_angle_rad(distance, v_along, v_across, limits);
  along_ = TrapezoidalProfile(distance, v_along, scaled(limits, std::cos(angle)));
  across_ = TrapezoidalProfile(0, v_across, scaled(limits, std::sin(angle)));
}

Vec2 TrapezoidalProfile2d::velocity_after(double seconds) const {
  return along_.velocity_after(seconds) * direction_ + across_.velocity_after(seconds) * left_of(direction_);
}

}  // namespace sidestep
