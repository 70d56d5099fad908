// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/steering.hpp"
#include "agents/safety/safety_search.hpp"
#include "agents/safety/trajectory_index.hpp"
#include "common/motion/validity.hpp"

namespace sidestep {

/// What an agent computes with and need not remember from one cycle to the next. The agents of a simulation
/// live in one thread and share one, which stays in the processor's caches while theirs come and go.
struct PlanningScratch {
  explicit PlanningScratch(const Scenario& scenario)
      : rules(floor_rules(scenario)),
        steering(rules.field, rules.radius_m, rules.limits),
        safety_search(rules, {}) {}

  const FloorRules rules;
  TrajectoryIndex crowd;
  Steering steering;
  SafetySearch safety_search;
};

}  // namespace sidestep
