// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/motion/version.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// The robots in a coordinator's state whose notices satisfy a condition.
template <typename Condition>
std::vector<RobotId> robots_where(const msg::CoordinatorState& state, Condition condition) {
  std::vector<RobotId> robots;
  for (const msg::RobotNotice& notice : state.notices()) {
    if (condition(notice)) robots.push_back(notice.robot());
  }
  return robots;
}

inline std::vector<RobotId> missing_robots(const msg::CoordinatorState& state) {
  return robots_where(state, [](const msg::RobotNotice& notice) { return notice.is_missing(); });
}
inline std::vector<RobotId> quarantined_robots(const msg::CoordinatorState& state) {
  return robots_where(state, [](const msg::RobotNotice& notice) { return notice.is_quarantined(); });
}
inline std::vector<RobotId> displaced_robots(const msg::CoordinatorState& state) {
  return robots_where(state, [](const msg::RobotNotice& notice) { return notice.is_displaced(); });
}

}  // namespace sidestep
