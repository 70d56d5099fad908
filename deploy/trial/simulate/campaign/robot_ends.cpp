// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/robot_ends.hpp"

#include <algorithm>

#include "deploy/trial/simulate/campaign/clock_sampler.hpp"

namespace sidestep {
namespace {

/// The last disturbance of this kind that the simulator has applied to the robot; nullptr if there is none.
const TimedFault* last_disturbance(const FaultPlan& plan, RobotId robot, msg::DisturbanceKind kind,
                                   Duration simulator_started) {
  const TimedFault* last = nullptr;
  for (const TimedFault& timed : plan.faults) {
    const auto* const disturbance = std::get_if<RobotDisturbance>(&timed.fault);
    if (disturbance && disturbance->robot == robot && disturbance->kind == kind &&
        timed.at >= simulator_started)
      last = &timed;
  }
  return last;
}

/// Change of the robot's clock offset from the start to the end of the run.
Duration clock_error(const FaultPlan& plan, const RobotSpec& robot, Duration simulator_started,
                     Duration duration) {
  const TimedFault* const step =
      last_disturbance(plan, robot.id, msg::DisturbanceKind::DISTURBANCE_CLOCK, simulator_started);
  const Duration set_at = step ? step->at : simulator_started;
  const Duration error =
      step ? std::get<RobotDisturbance>(step->fault).clock_offset - robot.clock_offset : Duration{0};
  return error + from_seconds(1e-6 * robot.clock_drift_ppm * to_seconds(duration - set_at));
}

}  // namespace

std::map<RobotId, RobotEnd> robot_ends(const FaultPlan& plan, const Scenario& scenario,
                                       Duration simulator_started, Duration duration) {
  std::map<RobotId, RobotEnd> ends;
  if (simulator_started == Duration{0}) return plan.ends;
  for (const auto& [robot, end] : plan.ends) {
    const bool is_clock = end == RobotEnd::kClockLeftBound || end == RobotEnd::kClockBeyondBound;
    if (is_clock) {
      const Duration error = clock_error(plan, *find_robot(scenario, robot), simulator_started, duration);
      ends[robot] = final_clock_state(error, scenario);
    } else if (end != RobotEnd::kLifted ||
               last_disturbance(plan, robot, msg::DisturbanceKind::DISTURBANCE_LIFT, simulator_started)) {
      ends[robot] = end;
    }
  }
  return ends;
}

}  // namespace sidestep
