// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"

namespace sidestep {

/// Robots' clocks that are wrong by more than this are noticed whatever the network and pauses do.
inline constexpr Duration kSurelyNoticed = std::chrono::seconds(6);

/// Draws the clocks of all processes that have a host, and of the robots. Robots' clocks differ from
/// coordinators' by less than the scenario's bound; in one of ten draws some, or all, by far more.
void sample_clocks(Scenario& scenario, FaultPlan& plan, Rng& rng);

}  // namespace sidestep
