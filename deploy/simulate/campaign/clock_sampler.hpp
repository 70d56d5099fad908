// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"

namespace sidestep {

/// Clock offsets of robots above this are detected regardless of network faults and pauses.
inline constexpr Duration kCertainlyDetectedOffset = std::chrono::seconds(6);

/// Samples the clock offsets of all processes on hosts, and of the robots. Robots' clocks differ from
/// coordinators' by less than the scenario's bound, except that in one of ten samples some or all differ by
/// far more.
void sample_clocks(Scenario& scenario, FaultPlan& plan, Rng& rng);

}  // namespace sidestep
