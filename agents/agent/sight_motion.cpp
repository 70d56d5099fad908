// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/sight_motion.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "agents/agent/planning_distances.hpp"
#include "agents/safety/safety_search.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

AccelerationCommand creep_away(const IntentToFollow& followed, const HiddenSpace& hidden,
                               const FloorRules& rules) {
  const State& at_start = followed.at_start;
  MotionLimits limits = rules.limits;
  limits.speed_mps = hidden.creep_mps;
  Vec2 away(0, 0);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Frontier& frontier : hidden.frontiers) {
    const Vec2 at = frontier.segment.from_m + nearest_offset(at_start.position_m, frontier.segment);
    const double distance_m = (at_start.position_m - at).norm() - frontier.bulge_m;
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    away = (at_start.position_m - at).stableNormalized();
  }
  return hold_towards(rules.radius_m * away, at_start.velocity_mps, limits, followed.hold);
}

}  // namespace

SightMotion follow_in_sight(const IntentToFollow& followed, Time start, double max_speed_mps,
                            const HiddenSpace& hidden, const FloorRules& rules) {
  constexpr std::array kFractions{1.0, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05};
  const State& at_start = followed.at_start;
  const double top_mps = std::min(max_speed_mps, rules.limits.speed_mps);
  for (const double fraction : kFractions) {
    MotionLimits limits = rules.limits;
    limits.speed_mps = fraction * top_mps;
    const AccelerationCommand command = follow(followed, limits.speed_mps);
    const Vec2 acceleration =
        limit_acceleration(command.acceleration_mps2, at_start.velocity_mps, limits, command.hold);
    const Trajectory trajectory =
        accelerate_then_stop(start, at_start, acceleration, command.hold, rules.limits.deceleration_mps2);
    if (is_passively_safe_from_hidden(trajectory, hidden, required_separation_m(rules)))
      return {command, false};
  }
  return {creep_away(followed, hidden, rules), true};
}

}  // namespace sidestep
