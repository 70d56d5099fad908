// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Samples faults of some seconds in which a process cannot receive, cannot send, or can receive from or send
/// to only some others. If there are several coordinators, such a fault of one of them may be permanent.
void sample_reception(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng);

}  // namespace sidestep
