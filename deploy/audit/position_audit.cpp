// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/position_audit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sidestep {
namespace {

// Rounding of positions and velocities in messages.
constexpr double kRounding_m = 1e-5;
// A robot that was moved learns this from vision within this time, and reports that it is off its reference.
constexpr std::int64_t kMaxSeenDisplacement_ns = 300'000'000;

}  // namespace

PositionAudit::PositionAudit(const AuditedRun& run, const RobotRecords& robots, const RunCoverage& coverage,
                             const Disturbances& disturbances, AuditFindings& findings)
    : run_(run),
      robots_(robots),
      coverage_(coverage),
      disturbances_(disturbances),
      findings_(findings),
      displacements_(robots.all().size()) {}

void PositionAudit::check(AuditedRobot& robot, const AuditedRobot::ReceivedReport& robot_report,
                          const Reception& reception) {
  SeenDisplacement& displacement = displacements_[robots_.index_of(robot)];
  const bool is_vision = coverage_.is_vision();
  AuditedRobot::Observation& pending = robot.observation;
  // A simulator of robots without firmware does not know their references.
  const bool is_seen = is_vision || pending.reference_error_m < 0;
  // If messages may be missed, the delay of reports is unknown, and so is the offset of the robot's clock.
  // That clock is then assumed to be within the clock bound of the clocks of cameras and such a simulator.
  const bool is_by_bound = is_vision || (is_seen && !run_.is_complete());
  const std::int64_t ahead_ns = robot_report.at_ns - reception.latest_ns;
  const std::int64_t clock_change_ns = ahead_ns - std::exchange(robot.clock_ahead_ns, ahead_ns);
  if (pending.at_ns == kNever) return;
  if (run_.is_complete() && !is_vision && std::abs(clock_change_ns) > run_.clock_bound_ns()) {
    // The clock has jumped since the observation, so the time of the observation on this clock is unknown.
    pending = {};
    return;
  }
  // The observation's time by the robot's clock.
  const std::int64_t at_ns = pending.at_ns + (is_by_bound ? 0 : ahead_ns);
  if (robot_report.at_ns < at_ns) return;
  const AuditedRobot::Observation observation = std::exchange(pending, {});
  if (!run_.is_complete() && !reception.is_next) {
    // Reports were missed, so what the robot did in between is unknown.
    displacement = {};
    return;
  }
  const bool is_off = robot_report.is_off_reference || robot_report.is_lifted || !robot.last_report ||
                      robot.last_report->is_off_reference || robot.last_report->is_lifted ||
                      (is_by_bound && !robot_report.is_clock_sound);
  const KnownVersion* executed = robot.executed_at(robot_report.executing, at_ns);
  // The robot may have begun and ended an own stop between the two reports.
  const bool may_be_off = !run_.is_complete() && executed && executed->is_own_stop;
  if (is_off || !executed || may_be_off) {
    displacement = {};
    return;
  }
  double error_m = observation.reference_error_m, inflation_m = executed->version.inflation_m();
  if (is_seen || run_.is_complete()) {
    const AuditPath::Node reference = executed->path.at_ns(at_ns);
    error_m = std::hypot(observation.x - reference.x, observation.y - reference.y);
  } else {
    // Ground truth that arrives late may be older than both reports.
    if (robot.last_report->at_ns > at_ns) return;
    // The times of live messages are not exact enough to say which of the two versions was executed.
    const KnownVersion* const before = robot.find(robot.last_report->executing);
    if (before) inflation_m = std::max(inflation_m, before->version.inflation_m());
  }
  findings_.totals.max_position_error_m = std::max(findings_.totals.max_position_error_m, error_m);
  if (is_seen)
    check_seen_position(robot, *executed, error_m, at_ns);
  else
    check_true_position(robot, *executed, error_m - inflation_m, at_ns);
}

// A robot that cannot use observations, because its clock is off, never learns that it was displaced. Others
// keep clear of it for as long as the coordinator names it.
bool PositionAudit::is_known_to_be_displaced(std::size_t robot) const {
  const bool was_disturbed = disturbances_.was_disturbed(robot);
  // The coordinator's messages may have been missed.
  if (!run_.is_complete() && was_disturbed) return true;
  return disturbances_.is_displaced(robot) || disturbances_.rests_displaced(robot) ||
         (was_disturbed && std::ranges::count(named_displaced_, robots_.all()[robot].id) > 0);
}

void PositionAudit::check_true_position(const AuditedRobot& robot, const KnownVersion& executed,
                                        double error_m, std::int64_t at_ns) {
  if (error_m <= run_.scenario.tracking_bound_m + kRounding_m) return;
  if (is_known_to_be_displaced(robots_.index_of(robot))) {
    ++findings_.totals.excused_displacements;
    return;
  }
  findings_.report(AuditRule::kPosition, robot.id, &executed, 0,
                   "is {:.6f} m from its reference, beyond its inflation, at {} ns; {:.6f} m allowed",
                   error_m, at_ns, run_.scenario.tracking_bound_m);
}

void PositionAudit::check_seen_position(const AuditedRobot& robot, const KnownVersion& executed,
                                        double error_m, std::int64_t at_ns) {
  SeenDisplacement& displacement = displacements_[robots_.index_of(robot)];
  const double bound_m =
      run_.scenario.tracking_bound_m + executed.version.inflation_m() + run_.observation_allowance_m();
  if (error_m <= bound_m) {
    const bool was_in_place = displacement.in_place_since_ns != kNever && displacement.since_ns == kNever;
    displacement = {kNever, false, was_in_place ? displacement.in_place_since_ns : at_ns};
    return;
  }
  // An auditor that joins a run does not know which robots were displaced before.
  if (!run_.is_complete() && displacement.in_place_since_ns == kNever) return;
  if (is_known_to_be_displaced(robots_.index_of(robot))) {
    ++findings_.totals.excused_displacements;
    return;
  }
  if (displacement.since_ns == kNever) displacement.since_ns = at_ns;
  if (displacement.is_reported || at_ns - displacement.since_ns <= kMaxSeenDisplacement_ns) return;
  displacement.is_reported = true;
  findings_.report(AuditRule::kPosition, robot.id, &executed, 0,
                   "is {:.6f} m from its reference at {} ns, as vision shows; {:.6f} m allowed", error_m,
                   at_ns, bound_m);
}

}  // namespace sidestep
