// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"

namespace sidestep {

/// Clock offsets of robots above this are detected regardless of network faults and pauses.
inline constexpr Duration kCertainlyDetectedOffset = std::chrono::seconds(6);

/// Samples the clock errors of all processes on hosts, and of the robots, for a run of this duration. Robots'
/// clocks differ from coordinators' by less than the scenario's bound all the time, except that in one of ten
/// samples some or all differ by far more, and that clocks of some robots drift out of the bound.
void sample_clocks(Scenario& scenario, FaultPlan& plan, Duration duration, Rng& rng);

/// How a robot ends whose clock was right and at the end is wrong by this much.
[[nodiscard]] RobotEnd end_of_clock(Duration error, const Scenario& scenario);

}  // namespace sidestep
