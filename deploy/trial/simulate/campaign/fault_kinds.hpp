// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "common/config/scenario.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"

namespace sidestep {

/// The kinds of faults in a trial, as names such as "kill" or "push".
[[nodiscard]] std::set<std::string> fault_kinds(const Scenario& scenario, const FaultPlan& plan);

}  // namespace sidestep
