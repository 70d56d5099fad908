// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/agent/planning_settings.hpp"
#include "common/motion/floor_rules.hpp"

namespace sidestep {

/// Required distance of the robot's centre from the edge of an obstacle.
inline double required_separation_m(const FloorRules& rules) { return rules.radius_m + rules.margin_m; }

/// Preferred distance of the robot's centre from the edge of an obstacle.
inline double planning_separation_m(const FloorRules& rules, const PlanningSettings& settings) {
  return rules.radius_m + rules.margin_m + settings.extra_clearance_m;
}

/// Distance between start positions beyond which versions cannot conflict.
inline double search_horizon_m(const FloorRules& rules, const PlanningSettings& settings) {
  const double speed = rules.limits.speed_mps;
  return 2 * speed * (settings.max_speed_hold_s + speed / (2 * rules.limits.deceleration_mps2)) +
         rules.min_separation_m();
}

/// Like search_horizon_m(), plus the distance that robots drive while a ledger page ages.
inline double page_horizon_m(const FloorRules& rules, const PlanningSettings& settings) {
  return search_horizon_m(rules, settings) + 2 * rules.limits.speed_mps * settings.max_page_age_s;
}

}  // namespace sidestep
