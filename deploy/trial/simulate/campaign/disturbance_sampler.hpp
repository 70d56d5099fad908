// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Adds disturbances of robots to a plan, in no particular order: pushes, slips, blocked wheels and restarts
/// of the firmware; robots that are lifted and placed again, carried, or lose power; clocks that jump; robots
/// that cameras see wrongly. Before the end of all faults the operator corrects most disturbances; the plan's
/// `ends` state the rest. Robots whose clocks are out of bounds are not lifted, because they could not be put
/// down again.
void sample_disturbances(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng);

}  // namespace sidestep
