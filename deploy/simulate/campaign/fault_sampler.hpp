// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"

namespace sidestep {

/// Samples faults of all kinds for a run of this duration. `processes` are all processes of the system. The
/// last `fault_free_end` of the run has no faults.
FaultPlan sample_faults(const Scenario& scenario, const ProcessNames& processes, Duration duration,
                        Duration fault_free_end, Rng& rng);

}  // namespace sidestep
