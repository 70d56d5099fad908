// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/fault_times.hpp"

namespace sidestep {

/// Clock offsets of robots above this are detected regardless of network faults and pauses.
inline constexpr Duration kCertainlyDetectedOffset = std::chrono::seconds(6);

/// Samples the clock errors of all processes on hosts, and of the robots, for a run of this duration. Robots'
/// clocks normally differ from the coordinators' by less than the scenario's bound throughout. In one of ten
/// samples, some or all differ by far more, and the clocks of some robots drift out of the bound. Robots
/// without their own clocks use the simulator's.
void sample_clocks(Scenario& scenario, FaultPlan& plan, Duration duration, bool robots_have_clocks, Rng& rng);

/// Samples jumps of processes' clocks by a millisecond to an hour; they are corrected before all faults end.
/// The simulator's clock is the clock of the ground truth, and does not jump.
void sample_clock_jumps(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng);

/// The final state of a robot whose clock was right at first and has this error at the end.
[[nodiscard]] RobotEnd final_clock_state(Duration error, const Scenario& scenario);

}  // namespace sidestep
