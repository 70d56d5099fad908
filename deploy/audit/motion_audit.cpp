// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/motion_audit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace sidestep {
namespace {

// A robot checks its tracking error once per millisecond, but may report a position from between two checks.
constexpr double kReportingTolerance_m = 0.0005;
// Robots whose motors take longer than this to respond cannot be driven.
constexpr std::int64_t kMaxMotorLead_ns = 300'000'000;
// Robots check themselves every millisecond. Beyond the drift bound they may take 25 ms to return.
constexpr std::int64_t kCheckPeriod_ns = 1'000'000;
constexpr std::int64_t kRecoveryTimeout_ns = 25'000'000 + kCheckPeriod_ns;
// A busy machine delays the next check of a process that drives robots. A robot that does not move away from
// its reference meanwhile endangers nobody, because it is within the tracking bound.
constexpr std::int64_t kMaxLateCheck_ns = 100'000'000;

}  // namespace

void MotionAudit::check_tracking(AuditedRobot& robot, const KnownVersion& executing,
                                 const AuditedRobot::ReceivedReport& robot_report,
                                 const msg::Feedback& feedback, const Reception& reception) {
  const std::int64_t drifted_since_ns = std::exchange(robot.drifted_since_ns, kNever);
  const std::int64_t beyond_since_ns = std::exchange(robot.beyond_bound_since_ns, kNever);
  const double drift_before_m = std::exchange(robot.max_drift_m, 0);
  // When a robot's clock is set, its reference jumps.
  if (!robot.last_report || !robot.last_report->is_clock_sound || !robot_report.is_clock_sound) return;
  if (robot_report.is_off_reference || robot_report.is_lifted || robot.last_report->is_off_reference) return;
  const double bound_m = run_.scenario.tracking_bound_m;
  const double error_m =
      feedback.tracking_error_m() - executing.version.inflation_m() - kReportingTolerance_m;
  const auto check = [&](double allowed_m, std::int64_t since_ns, std::int64_t timeout_ns) {
    if (!(error_m > allowed_m)) return kNever;
    // If reports were missed, the robot may have recovered in between.
    const std::int64_t first_ns = reception.is_next && since_ns != kNever ? since_ns : robot_report.at_ns;
    const std::int64_t lasted_ns = robot_report.at_ns - first_ns;
    if (lasted_ns > timeout_ns) {
      findings_.report(
          AuditRule::kTracking, robot.id, &executing, 0,

          "{:.6f} m off its reference by its own estimate, for at least {:.3f} s; {:.6f} m allowed",
          feedback.tracking_error_m(), static_cast<double>(lasted_ns) * 1e-9, allowed_m);
    }
    return first_ns;
  };
  const bool moves_away = error_m > drift_before_m + kReportingTolerance_m;
  robot.drifted_since_ns =
      check(drift_bound_m(bound_m), drifted_since_ns, moves_away ? kRecoveryTimeout_ns : kMaxLateCheck_ns);
  if (robot.drifted_since_ns != kNever)
    robot.max_drift_m = robot_report.at_ns - robot.drifted_since_ns <= kRecoveryTimeout_ns
                            ? std::max(drift_before_m, error_m)
                            : drift_before_m;
  robot.beyond_bound_since_ns = check(bound_m, beyond_since_ns, kCheckPeriod_ns);
}

void MotionAudit::check_own_stop(const AuditedRobot& robot, const KnownVersion& own_stop,
                                 std::int64_t lead_ns) {
  const auto fail = [&](const std::string& detail) {
    findings_.report(AuditRule::kOffReference, robot.id, &own_stop, 0, detail);
  };
  // An equal number means that the robot was already executing this stop, but that was missed.
  if (robot.last_report && own_stop.number < robot.last_report->executing)
    fail(fmt::format("is not numbered above version {}, which it replaces", robot.last_report->executing));
  const AuditPath::Node& end = own_stop.path.last();
  if (std::hypot(end.vx, end.vy) > 1e-5)
    fail(fmt::format("ends at {:.6f} m/s instead of at rest", std::hypot(end.vx, end.vy)));
  // After the lead time of the robot's motors, the stop brakes at D to rest.
  const double lead_s = static_cast<double>(std::clamp<std::int64_t>(lead_ns, 0, kMaxMotorLead_ns)) * 1e-9;
  const AuditPath::Node braked = own_stop.path.at_s(lead_s);
  const double speed = std::hypot(braked.vx, braked.vy);
  const double expected_s = lead_s + speed / run_.scenario.limits.deceleration_mps2;
  if (own_stop.path.duration_s() > 1.01 * expected_s + 0.001)
    fail(fmt::format("takes {:.4f} s to stop from {:.4f} m/s", own_stop.path.duration_s(), speed));
}

}  // namespace sidestep
