// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Samples orders by an operator and two other clients while faults happen: drive orders, holds of one robot
/// or all, resumes, and zones. Before the end of all faults every hold is lifted and every zone is removed,
/// so that robots drive at the end.
void sample_orders(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng);

}  // namespace sidestep
