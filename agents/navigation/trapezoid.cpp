// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/trapezoid.hpp"

#include <cmath>

namespace sidestep {

template <typename Add>
void Trapezoid::for_each_stretch(double distance, double velocity, const MotionLimits& limits, Add add) {
  const auto append = [&](double seconds, double acceleration) {
    if (seconds > 0) add(seconds, acceleration);
  };
  const double accelerate = limits.acceleration_mps2, brake = limits.deceleration_mps2,
               top = limits.speed_mps;
  // Seen from the side of the point where an immediate stop would end, the rest is always forward.
  const double stop = velocity * std::abs(velocity) / (2 * brake);
  const double sign = distance >= stop ? 1 : -1;
  double d = sign * distance, v = sign * velocity;
  if (v < 0) {
    append(-v / brake, sign * brake);
    d += v * v / (2 * brake);
    v = 0;
  } else if (v > top) {
    append((v - top) / brake, -sign * brake);
    d -= (v * v - top * top) / (2 * brake);
    v = top;
  }
  double peak = std::sqrt(
      std::max(0.0, 2 * accelerate * brake * (d + v * v / (2 * accelerate)) / (accelerate + brake)));
  double cruise_s = 0;
  if (peak > top) {
    cruise_s = (d - (top * top - v * v) / (2 * accelerate) - top * top / (2 * brake)) / top;
    peak = top;
  }
  append((peak - v) / accelerate, sign * accelerate);
  append(cruise_s, 0);
  append(peak / brake, -sign * brake);
}

Trapezoid::Trapezoid(double distance, double velocity, const MotionLimits& limits) : velocity_(velocity) {
  for_each_stretch(distance, velocity, limits, [this](double seconds, double acceleration) {
    stretches_[static_cast<std::size_t>(count_++)] = {seconds, acceleration};
  });
}

double Trapezoid::duration_s(double distance, double velocity, const MotionLimits& limits) {
  double total = 0;
  for_each_stretch(distance, velocity, limits, [&total](double seconds, double) { total += seconds; });
  return total;
}

double Trapezoid::duration_s() const {
  double total = 0;
  for (int i = 0; i < count_; ++i) total += stretches_[static_cast<std::size_t>(i)].seconds;
  return total;
}

double Trapezoid::velocity_after(double seconds) const {
  double v = velocity_;
  for (int i = 0; i < count_; ++i) {
    const Stretch& stretch = stretches_[static_cast<std::size_t>(i)];
    if (seconds <= stretch.seconds) return v + seconds * stretch.acceleration;
    v += stretch.seconds * stretch.acceleration;
    seconds -= stretch.seconds;
  }
  return 0;
}

namespace {

/// What an axis gets of the limits.
MotionLimits share(const MotionLimits& limits, double part) {
  return {limits.acceleration_mps2 * part, limits.deceleration_mps2 * part, limits.speed_mps * part};
}

/// The angle whose cosine is the share of the axis along the way and whose sine is that of the one across.
double balance(double distance, double v_along, double v_across, const MotionLimits& limits) {
  double low = 0, high = std::abs(v_across) < 1e-6 ? 1e-3 : 1.5707963267948966;
  for (int i = 0; i < 20 && high - low > 1e-4; ++i) {
    const double angle = 0.5 * (low + high);
    const double along_s = Trapezoid::duration_s(distance, v_along, share(limits, std::cos(angle)));
    const double across_s = Trapezoid::duration_s(0, v_across, share(limits, std::sin(angle)));
    (along_s < across_s ? low : high) = angle;
  }
  return 0.5 * (low + high);
}

Vec2 direction_of(const Vec2& to_go, const Vec2& velocity) {
  if (to_go.norm() > 1e-9) return to_go.normalized();
  return velocity.norm() > 1e-9 ? Vec2(velocity.normalized()) : Vec2(1, 0);
}

}  // namespace

Trapezoid2d::Trapezoid2d(const Vec2& to_go, const Vec2& velocity, const MotionLimits& limits)
    : direction_(direction_of(to_go, velocity)), along_(0, 0, limits), across_(0, 0, limits) {
  const double distance = to_go.norm();
  const double v_along = velocity.dot(direction_), v_across = velocity.dot(left_of(direction_));
  const double angle = balance(distance, v_along, v_across, limits);
  along_ = Trapezoid(distance, v_along, share(limits, std::cos(angle)));
  across_ = Trapezoid(0, v_across, share(limits, std::sin(angle)));
}

Vec2 Trapezoid2d::velocity_after(double seconds) const {
  return along_.velocity_after(seconds) * direction_ + across_.velocity_after(seconds) * left_of(direction_);
}

}  // namespace sidestep
