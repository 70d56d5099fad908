// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/robot_report_audit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

constexpr std::int64_t kRetention_ns = 1'500'000'000;
// Versions excluded longer ago than this were compared before they were excluded.
constexpr std::int64_t kRecentWindow_ns = 50'000'000;
// A robot's incarnation is that of its simulator (a clock reading in nanoseconds) plus the number of times
// that the robot's clock was set back. A later simulator's incarnation is higher by more than this.
constexpr std::uint64_t kMaxSetbacks = 100'000;
// If a robot is silent for this long, reports of an earlier simulator may be the true ones (PROTOCOL.md,
// "Processes that must be alone").
constexpr Duration kGoneAfter = std::chrono::seconds(1);

bool is_sane(const msg::Feedback& feedback) {
  return std::isfinite(feedback.x_m()) && std::isfinite(feedback.y_m()) && std::isfinite(feedback.vx_mps()) &&
         std::isfinite(feedback.vy_mps()) && std::isfinite(feedback.tracking_error_m()) &&
         is_valid_time(feedback.valid_at_ns());
}

const char* reason_of(Exclusion exclusion) {
  switch (exclusion) {
    case Exclusion::kOlder:
      return "a newer version was executed before it";
    case Exclusion::kLate:
      return "the robot had not executed it when its start passed";
    case Exclusion::kFenced:
      return "the robot had obeyed a later incarnation before executing it";
    default:
      return "the robot has been lifted off the floor since its grant";
  }
}

}  // namespace

std::optional<AuditedRobot::ReceivedReport> RobotReportAudit::check(AuditedRobot& robot,
                                                                    const msg::Feedback& feedback,
                                                                    const Reception& reception) {
  if (!is_sane(feedback)) {
    ++findings_.totals.invalid;
    return std::nullopt;
  }
  if (!reception.is_newest || !accept_incarnation(robot, feedback.header().incarnation()))
    return std::nullopt;
  const bool executes_nothing = feedback.is_lifted() && feedback.executing().version_number() == 0;
  KnownVersion* executing = executes_nothing ? nullptr : robots_.store(robot, feedback.executing());
  if (!executing && !executes_nothing) return std::nullopt;
  if (executing && feedback.is_off_reference() && !executing->was_executed && executing->sent_ns == kNever)
    executing->is_own_stop = true;
  const ReceivedReport robot_report = report_of(robot, feedback, reception);
  check_order(robot, robot_report, feedback.executing().start_ns(), reception.is_next);

  robot.advance_recent(to_ns(findings_.now) - kRecentWindow_ns - 20 * run_.latency_bound().count());
  pairs_.remember_evidence(robot);
  if (executing) check_executing(robot, *executing, robot_report, feedback, reception);
  exclude(robot, robot_report, reception);
  return robot_report;
}

void RobotReportAudit::keep(AuditedRobot& robot, const ReceivedReport& robot_report) {
  if (!robot.last_report) robot.traceable_from_ns = robot_report.at_ns + kMaxLead_ns;
  robot.last_report = robot_report;
  robot.heard_at = findings_.now;
  pairs_.check_changes(robot);
  robot.forget(to_ns(findings_.now) - kRetention_ns);
}

bool RobotReportAudit::accept_incarnation(AuditedRobot& robot, std::uint64_t incarnation) {
  if (!robot.last_report || incarnation == robot.last_report->robot_incarnation) return true;
  const bool is_setback = incarnation - robot.last_report->robot_incarnation <= kMaxSetbacks;
  const bool is_late = robot.last_report->robot_incarnation - incarnation <= kMaxSetbacks ||
                       findings_.now - robot.heard_at < kGoneAfter;
  if (incarnation < robot.last_report->robot_incarnation && is_late) return false;
  if (is_setback)
    robot.forget_times();
  else
    robot.reset();
  return true;
}

AuditedRobot::ReceivedReport RobotReportAudit::report_of(const AuditedRobot& robot,
                                                         const msg::Feedback& feedback,
                                                         const Reception& reception) const {
  ReceivedReport robot_report;
  robot_report.robot_incarnation = feedback.header().incarnation();
  robot_report.at_ns = feedback.valid_at_ns();
  robot_report.is_clock_sound = is_clock_sound(feedback, reception);
  robot_report.executing = feedback.executing().version_number();
  robot_report.obeyed_incarnation = feedback.obeyed_incarnation();
  robot_report.obeyed_epoch = feedback.obeyed_epoch();
  const bool is_same_epoch =
      robot.last_report && robot.last_report->obeyed_epoch == robot_report.obeyed_epoch;
  robot_report.epoch_since_ns = is_same_epoch ? robot.last_report->epoch_since_ns : reception.latest_ns;
  robot_report.is_off_reference = feedback.is_off_reference();
  robot_report.is_lifted = feedback.is_lifted();
  if (robot_report.is_lifted && robot_report.executing == 0)
    robot_report.last_executed = feedback.executing().base();
  return robot_report;
}

bool RobotReportAudit::is_clock_sound(const msg::Feedback& feedback, const Reception& reception) const {
  const std::int64_t bound_ns = run_.clock_bound_ns() + 1000;
  // A report's time is read from the robot's own clock, its header's stamp from the sending process's clock.
  const bool is_dated_as_sent = std::abs(feedback.valid_at_ns() - feedback.header().stamp_ns()) <= bound_ns;
  if (!run_.is_complete() && !is_dated_as_sent) return false;
  return feedback.valid_at_ns() - reception.latest_ns <= bound_ns &&
         reception.latest_ns - feedback.valid_at_ns() <= bound_ns + run_.latency_bound().count();
}

void RobotReportAudit::check_executing(AuditedRobot& robot, KnownVersion& executing,
                                       const ReceivedReport& robot_report, const msg::Feedback& feedback,
                                       const Reception& reception) {
  check_switch(robot, executing, robot_report);
  check_sent(robot, executing);
  motion_.check_tracking(robot, executing, robot_report, feedback, reception);
  epochs_.check_obeyed(robot, executing, feedback, reception);
  if (executing.is_own_stop && !executing.was_executed)
    motion_.check_own_stop(robot, executing, feedback.lead_ns());
  // Times read from a clock beyond its bound prove nothing, even after the clock has been set.
  if (robot_report.is_clock_sound) {
    KnownVersion* base = robot.find(executing.version.base());
    if (base && base->was_executed && robot.last_report && robot.last_report->executing == base->number)
      base->executed_until_ns = std::max(base->executed_until_ns, executing.path.start_ns());
    executing.executed_until_ns = std::max(executing.executed_until_ns, robot_report.at_ns);
  }
  executing.was_executed = true;
  // The version's base may have been received after the version was granted.
  if (executing.granted_in != 0 && !executing.is_own_stop && !executing.is_content_checked)
    content_.check_against_base(robot, executing);
}

void RobotReportAudit::check_order(const AuditedRobot& robot, const ReceivedReport& robot_report,
                                   std::int64_t start_ns, bool is_next) {
  if (!robot.last_report) return;
  const AuditedRobot::ReceivedReport& last = *robot.last_report;
  const auto fail = [&](const std::string& detail) {
    findings_.report(AuditRule::kFacts, robot.id, robot.find(robot_report.executing),
                     robot_report.obeyed_epoch, detail);
  };
  // A clock that was beyond its bound may be set back.
  const bool was_clock_sound = last.is_clock_sound && (run_.is_complete() || is_next);
  if (robot_report.at_ns < last.at_ns && was_clock_sound)
    fail(fmt::format("is stamped {} ns, earlier than the report before it, {} ns", robot_report.at_ns,
                     last.at_ns));
  if (robot_report.obeyed_incarnation < last.obeyed_incarnation)
    fail(fmt::format("obeys incarnation {} after incarnation {}", robot_report.obeyed_incarnation,
                     last.obeyed_incarnation));
  if (robot_report.obeyed_epoch < last.obeyed_epoch)
    fail(fmt::format("obeys epoch {} after epoch {}", robot_report.obeyed_epoch, last.obeyed_epoch));
  if (robot_report.executing != 0 && start_ns > robot_report.at_ns)
    fail(fmt::format("executes at {} ns a version that starts at {} ns", robot_report.at_ns, start_ns));
  if (robot_report.executing == 0 && !robot_report.is_lifted && last.executing > 0)
    fail(fmt::format("reports its initial rest after it has executed version {}", last.executing));
}

void RobotReportAudit::check_switch(const AuditedRobot& robot, const KnownVersion& to,
                                    const ReceivedReport& robot_report) {
  if (!robot.last_report || to.number == robot.last_report->executing || robot_report.is_off_reference)
    return;
  if (to.exclusion != Exclusion::kNone) {
    const AuditRule rule = to.exclusion == Exclusion::kLate     ? AuditRule::kLateSwitch
                           : to.exclusion == Exclusion::kFenced ? AuditRule::kStaleIncarnation
                                                                : AuditRule::kFacts;
    findings_.report(rule, robot.id, &to, 0, "is being executed, although {}", reason_of(to.exclusion));
    return;
  }
  // The robot may have executed several versions between two reports.
  const VersionNumber from = robot.last_report->executing;
  const KnownVersion* step = &to;
  while (step && step->version.base() > from && step->version.base() < step->number)
    step = robots_.base_of(robot, *step);
  if (!step || step->version.base() == from) return;
  // The robot may have been lifted and put down between the two reports.
  const bool may_follow_lift = step->version.base() == 0 && step->path.reach_m() == 0;
  if (!run_.is_complete() && may_follow_lift) return;
  findings_.report(AuditRule::kSwitch, robot.id, &to, 0, "continues version {}, but version {} was executed",
                   step->version.base(), from);
}

void RobotReportAudit::check_sent(AuditedRobot& robot, KnownVersion& executing) {
  if (!executing.was_executed && run_.is_complete() && !executing.is_own_stop &&
      executing.number > robot.max_evicted_version && executing.sent_ns == kNever &&
      !executing.is_reported_unsent) {
    executing.is_reported_unsent = true;
    findings_.report(AuditRule::kSent, robot.id, &executing, 0,
                     "is being executed, but no command contained it");
  }
}

void RobotReportAudit::exclude(AuditedRobot& robot, const ReceivedReport& robot_report,
                               const Reception& reception) const {
  for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
    KnownVersion& known = robot.versions[i];
    if (known.exclusion != Exclusion::kNone) continue;
    known.exclusion = exclusion_by(robot_report, known);
    if (known.exclusion != Exclusion::kNone) known.excluded_ns = to_ns(findings_.now);
    // If messages may be missed, the delay of reports is unknown, and only pages show what the ledger
    // contains.
    if (!known.has_content || !run_.is_complete()) continue;
    // If no report was missed, this is the first report that excludes the version, and no component could
    // know this earlier.
    if (known.exclusion == Exclusion::kNone || reception.is_next)
      known.in_ledger_until_ns = std::max(known.in_ledger_until_ns, reception.earliest_ns);
  }
}

}  // namespace sidestep
