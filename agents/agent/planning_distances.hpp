// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/motion/floor_rules.hpp"

namespace sidestep {

/// Preferred clearance in addition to the required clearance.
inline constexpr double kExtraClearance_m = 0.03;
/// Preferred additional clearances of robots with lasers, in descending order. The wider a robot passes a
/// corner, the earlier it sees what is behind it.
inline constexpr std::array<double, 4> kClearancesInSight_m{0.35, 0.2, 0.1, 0.03};
/// A robot whose version ends this close to its goal stays at that place.
inline constexpr double kAtGoal_m = 0.001;
/// A neighbour at rest this close to its goal is assumed to stay.
inline constexpr double kNeighbourAtGoal_m = 0.02;

/// Required distance of the robot's centre from the edge of an obstacle.
inline double required_separation_m(const FloorRules& rules) { return rules.radius_m + rules.margin_m; }

/// Preferred distance of the robot's centre from the edge of an obstacle.
inline double planning_separation_m(const FloorRules& rules) {
  return rules.radius_m + rules.margin_m + kExtraClearance_m;
}

/// Distance between start positions beyond which versions cannot conflict.
inline double search_horizon_m(const FloorRules& rules) {
  constexpr double kMaxSpeedHold_s = 0.15;  // longest time that a robot may hold maximum speed before braking
  const double speed = rules.limits.speed_mps;
  return 2 * speed * (kMaxSpeedHold_s + speed / (2 * rules.limits.deceleration_mps2)) +
         rules.min_separation_m();
}

/// Like search_horizon_m(), plus the distance that robots drive while a ledger page ages.
inline double page_horizon_m(const FloorRules& rules) {
  constexpr double kMaxPageAge_s = 0.1;  // maximum age of a ledger page at search time
  return search_horizon_m(rules) + 2 * rules.limits.speed_mps * kMaxPageAge_s;
}

}  // namespace sidestep
