// SPDX-License-Identifier: Apache-2.0
#include "common/motion/robot_model.hpp"

#include <algorithm>
#include <cmath>

#include "common/motion/rest.hpp"

namespace sidestep {
namespace {

double squared(double x) { return x * x; }

// The square of the norm whose unit ball is A(v); it is 1 on the boundary. The batch kernels perform the same
// operations in the same order (batch::ChoiceKernels::limit).
double effort2(const Vec2& a, const Vec2& v, const MotionLimits& limits) {
  const double sideways_and_ahead2 =
      (a.x() * a.x() + a.y() * a.y()) * (1 / squared(limits.acceleration_mps2));
  const double speed = v.norm();
  if (speed < kPlannedRest_mps) return sideways_and_ahead2;
  const double along = (a.x() * v.x() + a.y() * v.y()) * (1 / speed);
  if (along >= 0) return sideways_and_ahead2;
  const double across = (v.x() * a.y() - v.y() * a.x()) * (1 / speed);
  return along * along * (1 / squared(limits.deceleration_mps2)) +
         across * across * (1 / squared(limits.acceleration_mps2));
}

// The same norm at the end of a phase with this velocity. A phase that ends at rest has braked until then.
// The batch kernels compute the same.
double squared_effort_at_end(const Vec2& a, const Vec2& v, const MotionLimits& limits) {
  const double speed2 = v.x() * v.x() + v.y() * v.y();
  const double ahead = a.x() * v.x() + a.y() * v.y(), across = v.x() * a.y() - v.y() * a.x();
  if (speed2 < squared(kPlannedRest_mps)) return 0;
  if (ahead >= 0) return (a.x() * a.x() + a.y() * a.y()) * (1 / squared(limits.acceleration_mps2));
  const double per_speed2 = 1 / speed2;
  return ahead * ahead * per_speed2 * (1 / squared(limits.deceleration_mps2)) +
         across * across * per_speed2 * (1 / squared(limits.acceleration_mps2));
}

/// The requested acceleration, shortened until it may be held for the duration. If an acceleration is in A(v)
/// at the final velocity of a longer acceleration, it is also in A(v) at its own final velocity.
Vec2 scaled_to_admissible(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits,
                          double seconds) {
  const double at_start2 = effort2(acceleration, velocity, limits);
  const double at_end2 = squared_effort_at_end(acceleration, velocity + seconds * acceleration, limits);
  const double e2 = at_end2 > at_start2 ? at_end2 : at_start2;
  return e2 > 1 ? Vec2(acceleration * (1 / std::sqrt(e2))) : acceleration;
}

}  // namespace

bool is_admissible(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits) {
  return effort2(acceleration, velocity, limits) <= squared(1 + 1e-6);
}

// While the velocity changes, the angle between it and the acceleration only decreases. The permitted
// acceleration decreases too if D is at least F; otherwise it increases until the velocity has turned.
bool stays_admissible(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits,
                      Duration duration) {
  const Vec2 end = velocity + to_seconds(duration) * acceleration;
  return is_admissible(acceleration, velocity, limits) &&
         squared_effort_at_end(acceleration, end, limits) <= squared(1 + 1e-6);
}

Vec2 limit_acceleration(const Vec2& acceleration, const Vec2& velocity, const MotionLimits& limits,
                        Duration duration) {
  const double seconds = to_seconds(duration);
  const Vec2 after = velocity + seconds * acceleration;
  const double speed2 = after.x() * after.x() + after.y() * after.y();
  if (speed2 <= squared(limits.speed_mps))
    return scaled_to_admissible(acceleration, velocity, limits, seconds);
  // Scaling this acceleration towards zero keeps the speed limit, because the speeds that result from it and
  // from zero acceleration are both within the limit.
  const Vec2 slowed = (after * (limits.speed_mps / std::sqrt(speed2)) - velocity) * (1 / seconds);
  return scaled_to_admissible(slowed, velocity, limits, seconds);
}

Vec2 sample_acceleration(const Vec2& velocity, const MotionLimits& limits, Rng& rng) {
  Vec2 local;
  sample_in_velocity_frame(is_at_rest(velocity), limits, rng, 1, &local.x(), &local.y());
  const Vec2 forward = forward_of(velocity);
  return {local.x() * forward.x() - local.y() * forward.y(),
          local.x() * forward.y() + local.y() * forward.x()};
}

// Rejection sampling from the bounding rectangle of A(v), which fills pi / 4 of it. Rejected samples are
// overwritten, which costs less than unpredictable branches.
void sample_in_velocity_frame(bool is_at_rest, const MotionLimits& limits, Rng& rng, std::size_t count,
                              double* x, double* y) {
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

bool is_at_rest(const Vec2& velocity) { return velocity.norm() < kPlannedRest_mps; }

Vec2 forward_of(const Vec2& velocity) {
  const double speed = velocity.norm();
  return speed < kPlannedRest_mps ? Vec2(1, 0) : Vec2(velocity * (1 / speed));
}

}  // namespace sidestep
