// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

enum class JointMethod {
  kComposite,    ///< all robots planned as one
  kPrioritised,  ///< one after another
  kSafetySearch  ///< nothing planned jointly: the whole system in virtual time
};
[[nodiscard]] const char* name_of(JointMethod method);

struct JointTrial {
  bool solved = false;
  std::string fault{};  ///< found by the independent check; empty: none
  /// Of all robots together, over the whole run: processor time, or for the safety search, wall clock,
  /// accurate to 12 %, without cycles of more than a millisecond, in which other processes ran.
  double plan_us = 0;
  double makespan_ratio = 0;  ///< over the longest straight line; 0 unless solved
  double cycle_us = 0,
         cycle_p99_us = 0;  ///< one robot's planning in one control cycle; only the safety search
};

/// Lets a method solve a scene. `budget_s`: processor time that explicit planners may spend. The safety
/// search has solved a scene if all robots arrive within the scenario's time limit.
[[nodiscard]] JointTrial run_joint_trial(JointMethod method, const Scenario& scenario, double budget_s,
                                         std::uint64_t seed);

}  // namespace sidestep
