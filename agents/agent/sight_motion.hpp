// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/agent/desired_motion.hpp"
#include "agents/safety/hidden_space.hpp"
#include "common/motion/floor_rules.hpp"

namespace sidestep {

/// A desired motion of a robot with a laser.
struct SightMotion {
  AccelerationCommand command;
  bool is_creeping =
      false;  ///< no speed was safe, so the robot only moves away from where people may step out
};

/// Like follow(), but limited to the highest speed at which the robot comes to rest before a hidden person
/// can touch it. If there is no such speed, the robot moves away from the place where a person may step out,
/// so slowly that it counts as being at rest. The motion starts at `start`.
[[nodiscard]] SightMotion follow_in_sight(const IntentToFollow& followed, Time start, double max_speed_mps,
                                          const HiddenSpace& hidden, const FloorRules& rules);

}  // namespace sidestep
