// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/motion/version.hpp"

namespace sidestep {

inline bool is_same(const Intent& a, const Intent& b) {
  return a.velocity_mps == b.velocity_mps && a.velocity_duration_s == b.velocity_duration_s &&
         a.waypoint_m == b.waypoint_m && a.goal_m == b.goal_m && a.target_m == b.target_m && a.due == b.due;
}

inline bool is_same(const Trajectory& a, const Trajectory& b) {
  const auto is_same_phase = [](const MotionPhase& p, const MotionPhase& q) {
    return p.duration == q.duration && p.acceleration_mps2 == q.acceleration_mps2;
  };
  return a.start() == b.start() && a.at_start().position_m == b.at_start().position_m &&
         a.at_start().velocity_mps == b.at_start().velocity_mps &&
         std::ranges::equal(a.phases(), b.phases(), is_same_phase);
}

/// Whether all members of two versions are equal.
inline bool is_same(const Version& a, const Version& b) {
  return a.robot == b.robot && a.incarnation == b.incarnation && a.number == b.number && a.base == b.base &&
         is_same(a.trajectory, b.trajectory) && a.inflation_m == b.inflation_m &&
         a.intent.has_value() == b.intent.has_value() && (!a.intent || is_same(*a.intent, *b.intent));
}

}  // namespace sidestep
