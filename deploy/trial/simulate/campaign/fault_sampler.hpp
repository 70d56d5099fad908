// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Samples hosts, network faults and process faults, in no particular order. `processes` are all processes of
/// the system.
FaultPlan sample_faults(const Scenario& scenario, const ProcessNames& processes, const FaultTimes& times,
                        Rng& rng);

}  // namespace sidestep
