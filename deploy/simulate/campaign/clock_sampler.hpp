// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"
#include "deploy/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Clock offsets of robots above this are detected regardless of network faults and pauses.
inline constexpr Duration kCertainlyDetectedOffset = std::chrono::seconds(6);

/// Samples the clock errors of all processes on hosts, and of the robots, for a run of this duration. Robots'
/// clocks differ from coordinators' by less than the scenario's bound all the time, except that in one of ten
/// samples some or all differ by far more, and that clocks of some robots drift out of the bound. Robots
/// that have no clocks of their own have the simulator's.
void sample_clocks(Scenario& scenario, FaultPlan& plan, Duration duration, bool have_robots_clocks, Rng& rng);

/// Samples jumps of processes' clocks by a millisecond to an hour, which are put right before all faults end.
/// The simulator's clock is that of the ground truth and does not jump.
void sample_clock_jumps(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng);

/// How a robot ends whose clock was right and at the end is wrong by this much.
[[nodiscard]] RobotEnd end_of_clock(Duration error, const Scenario& scenario);

}  // namespace sidestep
