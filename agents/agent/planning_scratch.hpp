// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/steering.hpp"
#include "agents/safety/safety_search.hpp"
#include "agents/safety/trajectory_index.hpp"
#include "common/config/scenario.hpp"
#include "common/motion/floor_rules.hpp"

namespace sidestep {

/// Working memory of planning, with no state that outlives a cycle. The agents of a simulation run in one
/// thread and share one instance, which therefore stays in the processor's caches.
struct PlanningScratch {
  explicit PlanningScratch(const FloorSpec& floor)
      : rules(floor_rules(floor)),
        steering(rules.field, rules.radius_m, rules.limits),
        safety_search(rules) {}

  const FloorRules rules;
  TrajectoryIndex others;
  Steering steering;
  SafetySearch safety_search;
};

}  // namespace sidestep
