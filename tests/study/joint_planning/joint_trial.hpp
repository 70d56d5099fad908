// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

enum class JointMethod {
  kComposite,    ///< all robots planned together as one
  kPrioritised,  ///< robots planned one after another
  kSafetySearch  ///< no joint planning: the whole system in virtual time
};
[[nodiscard]] const char* name_of(JointMethod method);

struct JointTrial {
  bool solved = false;
  std::string fault{};  ///< fault found by the independent check; empty: none
  /// Planning time, total over all robots and the whole run. For planners this is processor time. For the
  /// safety search it is wall-clock time, accurate to 12 %, and excludes cycles longer than a millisecond,
  /// which other processes have interrupted.
  double plan_us = 0;
  double makespan_ratio = 0;  ///< makespan relative to the longest straight motion; 0 unless solved
  double cycle_us = 0,
         cycle_p99_us = 0;  ///< one robot's planning in one control cycle; only for the safety search
};

/// Solves a scene with a method. `budget_s` is the maximum processor time of explicit planners. The safety
/// search has solved a scene if all robots arrive within the scenario's time limit.
[[nodiscard]] JointTrial run_joint_trial(JointMethod method, const Scenario& scenario, double budget_s,
                                         std::uint64_t seed);

}  // namespace sidestep
