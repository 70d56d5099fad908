// SPDX-License-Identifier: Apache-2.0
// Checks of what robots report.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "deploy/audit/auditor.hpp"
#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

constexpr std::int64_t kRetention_ns = 1'500'000'000;
// Versions excluded longer ago than this were compared before they were excluded.
constexpr std::int64_t kRecentWindow_ns = 50'000'000;
// A robot checks its tracking error once per millisecond, but reports the position in between.
constexpr double kReportingTolerance_m = 0.0005;
// Robots whose motors respond later than this are not driven.
constexpr std::int64_t kMaxMotorLead_ns = 300'000'000;
// Robots check themselves every millisecond. Beyond the drift bound they may take 25 ms to return.
constexpr std::int64_t kCheckPeriod_ns = 1'000'000;
constexpr std::int64_t kRecoveryTimeout_ns = 25'000'000 + kCheckPeriod_ns;

// A robot's incarnations count up from its simulator's incarnation, which is a clock reading in nanoseconds.
// Another simulator starts with a later reading.
constexpr std::uint64_t kMaxSetbacks = 100'000;
// If a robot is silent for this long, facts of an earlier simulator may be the true ones (PROTOCOL.md,
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
      return "its start had passed before the robot executed it";
    case Exclusion::kFenced:
      return "the robot had obeyed a later incarnation by then without executing it";
    default:
      return "the robot has been lifted off the floor since its grant";
  }
}

}  // namespace

bool Auditor::is_clock_sound(const msg::Feedback& feedback, const Reception& reception) const {
  // A fact's time is by the robot's own clock, and its stamp by the clock of the process that sends it.
  const bool is_dated_as_sent =
      std::abs(feedback.valid_at_ns() - feedback.header().stamp_ns()) <= clock_bound_ns_ + 1000;
  if (!input_.is_complete && !is_dated_as_sent) return false;
  return feedback.valid_at_ns() - reception.latest_ns <= clock_bound_ns_ + 1000 &&
         reception.latest_ns - feedback.valid_at_ns() <=
             clock_bound_ns_ + 1000 + (input_.is_complete ? 0 : input_.min_latency_bound.count());
}

void Auditor::on_robot_report(const msg::Feedback& feedback, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(feedback.robot(), feedback.header());
  if (!robot) return;
  const Reception reception = trace(kRobotReportKind, feedback.robot(), feedback.header());
  if (!is_sane(feedback)) {
    ++totals_.invalid;
    return;
  }
  if (!reception.is_newest) return;
  const std::uint64_t robot_incarnation = feedback.header().incarnation();
  if (robot->last_report && robot_incarnation != robot->last_report->robot_incarnation) {
    const bool is_setback = robot_incarnation - robot->last_report->robot_incarnation <= kMaxSetbacks;
    const bool is_late = robot->last_report->robot_incarnation - robot_incarnation <= kMaxSetbacks ||
                         now - robot->heard_at < kGoneAfter;
    if (robot_incarnation < robot->last_report->robot_incarnation && is_late) return;
    if (is_setback)
      robot->forget_times();
    else
      robot->reset();
    observations_[index_of(*robot)] = {};
  }
  const bool executes_nothing = feedback.is_lifted() && feedback.executing().version_number() == 0;
  if (!executes_nothing) {
    KnownVersion* executing = store(*robot, feedback.executing());
    if (!executing) return;
    if (feedback.is_off_reference() && !executing->was_executed && executing->sent_ns == kNever) {
      executing->is_own_stop = true;
    }
  }
  hear_robot_report(*robot, feedback.executing().version_number(), reception);
  AuditedRobot::ReceivedReport robot_report;
  robot_report.robot_incarnation = robot_incarnation;
  robot_report.at_ns = feedback.valid_at_ns();
  robot_report.earliest_ns = reception.earliest_ns;
  robot_report.latest_ns = reception.latest_ns;
  robot_report.executing = feedback.executing().version_number();
  robot_report.obeyed_incarnation = feedback.obeyed_incarnation();
  robot_report.obeyed_epoch = feedback.obeyed_epoch();
  const bool is_same_epoch =
      robot->last_report && robot->last_report->obeyed_epoch == robot_report.obeyed_epoch;
  robot_report.epoch_since_ns = is_same_epoch ? robot->last_report->epoch_since_ns : reception.latest_ns;
  robot_report.is_off_reference = feedback.is_off_reference();
  robot_report.is_lifted = feedback.is_lifted();
  if (executes_nothing) robot_report.last_executed = feedback.executing().base();
  check_report_order(*robot, feedback, reception);

  robot->advance_recent(to_ns(now_) - kRecentWindow_ns -
                        (input_.is_complete ? 0 : 20 * input_.min_latency_bound.count()));
  earlier_evidence_.clear();
  for (std::size_t i = robot->first_recent; i < robot->versions.size(); ++i)
    earlier_evidence_.push_back(evidence_of(robot->versions[i]));
  if (!executes_nothing) {
    KnownVersion& executing = *robot->find(feedback.executing().version_number());
    check_switch(*robot, executing, feedback);
    check_sent(*robot, executing);
    check_tracking(*robot, executing, feedback, reception);
    check_obeyed_epochs(*robot, executing, feedback, reception);
    if (executing.is_own_stop && !executing.was_executed)
      check_own_stop(*robot, executing, feedback.lead_ns());
    // The times of a clock that is out of bounds prove nothing, even after the clock has been set.
    if (is_clock_sound(feedback, reception)) {
      KnownVersion* base = robot->find(executing.version.base());
      if (base && base->was_executed && robot->last_report && robot->last_report->executing == base->number)
        base->executed_until_ns = std::max(base->executed_until_ns, executing.path.start_ns());
      executing.executed_until_ns = std::max(executing.executed_until_ns, feedback.valid_at_ns());
    }
    executing.was_executed = true;
    // Its base may have been received since its grant.
    if (executing.granted_in != 0 && !executing.is_own_stop && !executing.is_content_checked)
      check_against_base(*robot, executing);
  }
  exclude(*robot, robot_report, reception, to_ns(now_));
  has_sound_clock_[index_of(*robot)] = is_clock_sound(feedback, reception);
  check_position(*robot, feedback, reception);

  if (!robot->last_report) robot->traceable_from_ns = robot_report.at_ns + kMaxLead_ns;
  robot->last_report = robot_report;
  robot->heard_at = now_;

  check_pairs(*robot, earlier_evidence_);
  robot->forget(to_ns(now_) - kRetention_ns);
}

void Auditor::check_report_order(const AuditedRobot& robot, const msg::Feedback& feedback,
                                 const Reception& reception) {
  if (!robot.last_report) return;
  const AuditedRobot::ReceivedReport& last = *robot.last_report;
  const VersionNumber number = feedback.executing().version_number();
  const auto fail = [&](const std::string& detail) {
    report(AuditRule::kFacts, robot.id, robot.find(number), feedback.obeyed_epoch(), detail);
  };
  // A clock that was out of bounds may be set back.
  const bool was_clock_sound = has_sound_clock_[index_of(robot)] && (input_.is_complete || reception.is_next);
  if (feedback.valid_at_ns() < last.at_ns && was_clock_sound)
    fail(
        fmt::format("is stamped {} ns and follows a fact stamped {} ns", feedback.valid_at_ns(), last.at_ns));
  if (feedback.obeyed_incarnation() < last.obeyed_incarnation)
    fail(fmt::format("obeys incarnation {} after incarnation {}", feedback.obeyed_incarnation(),
                     last.obeyed_incarnation));
  if (feedback.obeyed_epoch() < last.obeyed_epoch)
    fail(fmt::format("obeys epoch {} after epoch {}", feedback.obeyed_epoch(), last.obeyed_epoch));
  if (number != 0 && feedback.executing().start_ns() > feedback.valid_at_ns())
    fail(fmt::format("executes at {} ns a version that starts at {} ns", feedback.valid_at_ns(),
                     feedback.executing().start_ns()));
  if (number == 0 && !feedback.is_lifted() && last.executing > 0)
    fail(fmt::format("reports its initial rest after version {}", last.executing));
}

void Auditor::check_switch(const AuditedRobot& robot, const KnownVersion& to, const msg::Feedback& feedback) {
  if (!robot.last_report || to.number == robot.last_report->executing || feedback.is_off_reference()) return;
  if (to.exclusion != Exclusion::kNone) {
    const AuditRule rule = to.exclusion == Exclusion::kLate     ? AuditRule::kLateSwitch
                           : to.exclusion == Exclusion::kFenced ? AuditRule::kStaleIncarnation
                                                                : AuditRule::kFacts;
    report(rule, robot.id, &to, 0, fmt::format("is executed, although {}", reason_of(to.exclusion)));
    return;
  }
  // The robot may have executed several versions between two facts.
  const VersionNumber from = robot.last_report->executing;
  const KnownVersion* step = &to;
  while (step && step->version.base() > from && step->version.base() < step->number)
    step = base_of(robot, *step);
  if (!step || step->version.base() == from) return;
  // It may have been lifted and put down in between.
  const bool may_follow_lift = step->version.base() == 0 && step->path.reach_m() == 0;
  if (!input_.is_complete && may_follow_lift) return;
  report(AuditRule::kSwitch, robot.id, &to, 0,
         fmt::format("continues version {}, but version {} was executed", step->version.base(), from));
}

void Auditor::check_sent(AuditedRobot& robot, KnownVersion& executing) {
  if (!executing.was_executed && input_.is_complete && !executing.is_own_stop &&
      executing.number > robot.max_evicted_version && executing.sent_ns == kNever &&
      !executing.is_reported_unsent) {
    executing.is_reported_unsent = true;
    report(AuditRule::kSent, robot.id, &executing, 0, "is executed, but no command contained it");
  }
}

void Auditor::check_tracking(AuditedRobot& robot, const KnownVersion& executing,
                             const msg::Feedback& feedback, const Reception& reception) {
  const std::int64_t drifted_since_ns = std::exchange(robot.drifted_since_ns, kNever);
  const std::int64_t beyond_since_ns = std::exchange(robot.beyond_bound_since_ns, kNever);
  // Setting a robot's clock displaces its reference at once.
  if (!has_sound_clock_[index_of(robot)] || !is_clock_sound(feedback, reception)) return;
  if (feedback.is_off_reference() || feedback.is_lifted() || !robot.last_report ||
      robot.last_report->is_off_reference)
    return;
  const double error_m =
      feedback.tracking_error_m() - executing.version.inflation_m() - kReportingTolerance_m;
  const auto check = [&](double bound_m, std::int64_t since_ns, std::int64_t timeout_ns) {
    if (!(error_m > bound_m)) return kNever;
    // If facts were missed, the robot may have recovered in between.
    const std::int64_t first_ns = reception.is_next && since_ns != kNever ? since_ns : feedback.valid_at_ns();
    const std::int64_t lasted_ns = feedback.valid_at_ns() - first_ns;
    if (lasted_ns > timeout_ns) {
      report(AuditRule::kTracking, robot.id, &executing, 0,
             fmt::format(
                 "{:.6f} m off its reference by its own estimate, for at least {:.3f} s; {:.6f} m allowed",
                 feedback.tracking_error_m(), static_cast<double>(lasted_ns) * 1e-9, bound_m));
    }
    return first_ns;
  };
  robot.drifted_since_ns = check(drift_bound_m(tracking_bound_m_), drifted_since_ns, kRecoveryTimeout_ns);
  robot.beyond_bound_since_ns = check(tracking_bound_m_, beyond_since_ns, kCheckPeriod_ns);
}

void Auditor::check_own_stop(const AuditedRobot& robot, const KnownVersion& own_stop, std::int64_t lead_ns) {
  const auto fail = [&](const std::string& detail) {
    report(AuditRule::kOffReference, robot.id, &own_stop, 0, detail);
  };
  // With the same number, it is the stop that the robot is already executing, and messages about it were
  // missed.
  if (robot.last_report && own_stop.number < robot.last_report->executing)
    fail(fmt::format("is not numbered above version {}, which it replaces", robot.last_report->executing));
  const AuditPath::Node& end = own_stop.path.last();
  if (std::hypot(end.vx, end.vy) > 1e-5)
    fail(fmt::format("ends at {:.6f} m/s instead of at rest", std::hypot(end.vx, end.vy)));
  // The stop brakes at D to rest, after the motion that is already under way in motors that respond late.
  const double lead_s = static_cast<double>(std::clamp<std::int64_t>(lead_ns, 0, kMaxMotorLead_ns)) * 1e-9;
  const AuditPath::Node braked = own_stop.path.at_s(lead_s);
  const double speed = std::hypot(braked.vx, braked.vy);
  const double expected_s = lead_s + speed / scenario_.limits.deceleration_mps2;
  if (own_stop.path.duration_s() > 1.01 * expected_s + 0.001)
    fail(fmt::format("takes {:.4f} s to stop from {:.4f} m/s", own_stop.path.duration_s(), speed));
}

void Auditor::check_obeyed_epochs(AuditedRobot& robot, const KnownVersion& executing,
                                  const msg::Feedback& feedback, const Reception& reception) {
  const bool is_switch = robot.last_report && robot.last_report->executing != executing.number;
  if (is_switch && executing.sent_ns != kNever && input_.is_complete &&
      executing.sent_ns > robot.last_report->epoch_since_ns &&
      executing.sent_epoch < robot.last_report->obeyed_epoch) {
    report(AuditRule::kStaleEpoch, robot.id, &executing, executing.sent_epoch,
           fmt::format("was sent after the robot had obeyed epoch {}", robot.last_report->obeyed_epoch));
  }
  // A robot that executes a version of an epoch obeys that epoch, and its agent has registered in it.
  if (!input_.is_complete && executing.granted_in > feedback.obeyed_epoch() && executing.is_proposed &&
      !executing.is_own_stop && !epoch_record(executing.granted_in).is_reported) {
    epoch_record(executing.granted_in).is_reported = true;
    report(AuditRule::kAllRegistered, robot.id, &executing, executing.granted_in,
           fmt::format("still obeys epoch {}, so it cannot have registered before the grant",
                       feedback.obeyed_epoch()));
  }
  // If messages may be missing, the order of facts and grants is unknown, and so are attestations of absence.
  for (auto& [epoch, record] : epochs_) {
    if (!input_.is_complete) break;
    if (record.is_reported || feedback.is_lifted() || feedback.obeyed_epoch() >= epoch) continue;
    if (record.first_grant_ns >= reception.earliest_ns) continue;
    if (epoch <= std::max(robot.attested_until, robot.forgotten_in)) continue;
    record.is_reported = true;
    report(AuditRule::kAllRegistered, robot.id, nullptr, epoch,
           fmt::format("still obeys epoch {}, so it cannot have registered before the first grant",
                       feedback.obeyed_epoch()));
  }
  if (robot.registered && !robot.registered->is_reported && is_after_registration(robot, feedback, reception))
    check_registration(robot, executing, feedback);
}

bool Auditor::is_after_registration(const AuditedRobot& robot, const msg::Feedback& feedback,
                                    const Reception& reception) const {
  const AuditedRobot::Registered& registered = *robot.registered;
  if (input_.is_complete) return registered.latest_ns < reception.earliest_ns;
  // The robot repeats the time of a command that the agent sent after the registration.
  return feedback.obeyed_incarnation() == registered.incarnation &&
         stamps_.tell_order(robot.id, registered.incarnation) &&
         feedback.command_stamp_ns() > registered.stamp_ns;
}

void Auditor::check_registration(AuditedRobot& robot, const KnownVersion& executing,
                                 const msg::Feedback& feedback) {
  AuditedRobot::Registered& registered = *robot.registered;
  if (feedback.obeyed_epoch() < registered.epoch || feedback.obeyed_incarnation() < registered.incarnation) {
    registered.is_reported = true;
    report(AuditRule::kAcknowledged, robot.id, nullptr, registered.epoch,
           fmt::format("incarnation {} registered, but the robot later obeys incarnation {} and epoch {}",
                       registered.incarnation, feedback.obeyed_incarnation(), feedback.obeyed_epoch()));
    return;
  }
  const bool is_known_older =
      executing.number == 0 || (executing.granted_in != 0 && executing.granted_in < registered.epoch);
  const bool is_registered =
      std::ranges::find(registered.versions, executing.number) != registered.versions.end();
  if (!is_known_older || is_registered || executing.is_own_stop || feedback.is_lifted()) return;
  registered.is_reported = true;
  report(AuditRule::kRegistration, robot.id, &executing, registered.epoch,
         fmt::format("is executed after the registration, which does not contain it; granted in epoch {}",
                     executing.granted_in));
}

void Auditor::exclude(AuditedRobot& robot, const AuditedRobot::ReceivedReport& robot_report,
                      const Reception& reception, std::int64_t now_ns) {
  for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
    KnownVersion& known = robot.versions[i];
    if (known.exclusion != Exclusion::kNone) continue;
    known.exclusion = exclusion_by(robot_report, known);
    if (known.exclusion != Exclusion::kNone) known.excluded_ns = now_ns;
    // If messages may be missing, the delay of a fact is unknown: only pages show what the ledger contains.
    if (!known.has_content || !input_.is_complete) continue;
    // If no fact was missed, this is the first one that excludes the version, and no component could know
    // earlier.
    if (known.exclusion == Exclusion::kNone || reception.is_next)
      known.alive_until_ns = std::max(known.alive_until_ns, reception.earliest_ns);
  }
}

}  // namespace sidestep
