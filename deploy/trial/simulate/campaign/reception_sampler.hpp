// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Samples processes that cannot receive, cannot send, or can receive from or send to only some others, for
/// seconds. If there are several coordinators, one of them may stay so permanently.
void sample_reception(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng);

}  // namespace sidestep
