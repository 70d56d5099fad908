// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"
#include "deploy/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Samples processes that are deaf, mute, or hear or reach only some others, for seconds; where there are
/// several coordinators, also one that stays so for good.
void sample_reception(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng);

}  // namespace sidestep
