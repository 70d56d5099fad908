// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/desired_motion.hpp"

#include <algorithm>

namespace sidestep {

AccelerationCommand follow(const IntentToFollow& followed, double max_speed_mps) {
  const Intent& intent = followed.intent;
  const State& at_start = followed.at_start;
  const double length = followed.length_m;
  MotionLimits limits = followed.limits;
  Vec2 displacement = length * (intent.waypoint_m - at_start.position_m).stableNormalized();
  if (intent.velocity_duration_s > 0) {
    const double speed = intent.velocity_mps.norm();
    const bool is_standstill = speed < followed.standstill_mps;
    displacement = is_standstill ? Vec2::Zero() : Vec2(length / speed * intent.velocity_mps);
    if (!is_standstill) limits.speed_mps = speed;
  }
  limits.speed_mps = std::min(limits.speed_mps, max_speed_mps);
  return hold_towards(displacement, at_start.velocity_mps, limits, followed.hold);
}

}  // namespace sidestep
