// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"

namespace sidestep {

/// Draws a mix of faults for a run of so long. `processes` are all of the system. The last `calm` of the run
/// is free of faults.
FaultPlan sample_faults(const Scenario& scenario, const ProcessNames& processes, Duration duration,
                      Duration calm, Rng& rng);

}  // namespace sidestep
