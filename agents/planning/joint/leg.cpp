// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/leg.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

Duration rounded_up(double seconds) { return Duration{static_cast<std::int64_t>(std::ceil(seconds * 1e9))}; }

}  // namespace

LegTimes leg_times(double distance_m, const MotionLimits& limits) {
  if (distance_m <= 0) return {};
  const double accelerate = limits.acceleration_mps2, brake = limits.deceleration_mps2;
  // Without cruising, d = v² / 2F + v² / 2D.
  const double peak = std::sqrt(2 * distance_m * accelerate * brake / (accelerate + brake));
  const double speed = std::min(peak, limits.speed_mps);
  const double ramps_m = speed * speed / 2 * (1 / accelerate + 1 / brake);
  return {rounded_up(speed / accelerate), rounded_up(std::max(0.0, distance_m - ramps_m) / speed),
          rounded_up(speed / brake)};
}

Trajectory make_leg(Time start, const Vec2& from_m, const Vec2& to_m, const LegTimes& times) {
  Trajectory leg = Trajectory::resting(start, from_m);
  if (times.total() == Duration{0}) return leg;
  // The speed at which exactly this distance is covered in these times.
  const double accelerate_s = to_seconds(times.accelerate), brake_s = to_seconds(times.brake);
  const Vec2 velocity = (to_m - from_m) / ((accelerate_s + brake_s) / 2 + to_seconds(times.cruise));
  leg.append(times.accelerate, velocity / accelerate_s);
  if (times.cruise > Duration{0}) leg.append(times.cruise, Vec2::Zero());
  leg.append(times.brake, -velocity / brake_s);
  return leg;
}

Trajectory clipped(const Trajectory& trajectory, Time from, Time until) {
  Trajectory part(from, trajectory.state_at(from));
  Time at = trajectory.start();
  for (const MotionPhase& phase : trajectory.phases()) {
    const Time begin = std::max(at, from);
    at += phase.duration;
    const Time end = std::min(at, until);
    if (end <= begin) continue;
    part.append(end - begin, phase.acceleration_mps2);
  }
  return part;
}

}  // namespace sidestep
