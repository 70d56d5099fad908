// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "common/config/scenario.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"

namespace sidestep {

/// The states in which robots end a run of this duration. `simulator_started` is when the simulator that is
/// alive at the end started: it puts all robots on the floor, with the scenario's clocks, regardless of what
/// happened to them before.
[[nodiscard]] std::map<RobotId, RobotEnd> robot_ends(const FaultPlan& plan, const Scenario& scenario,
                                                     Duration simulator_started, Duration duration);

}  // namespace sidestep
