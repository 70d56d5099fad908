// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent_event_logger.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/messaging/blockage_text.hpp"
#include "common/messaging/enumerator.hpp"
#include "common/protocol/process_names.hpp"
#include "common/protocol/reason_text.hpp"

namespace sidestep {
namespace {

/// A new limit is reported if it differs from the reported one by more than this fraction.
constexpr double kLimitChange = 0.2;

/// Whether an event last reported at `last` may be reported again. If so, sets `last` to `now`.
bool may_report(std::optional<Time>& last, Time now) {
  if (last && now - *last < AgentEventLogger::kMinInterval) return false;
  last = now;
  return true;
}

}  // namespace

void AgentEventLogger::update(const AgentActivity& activity, const ClockSpeedLimit& limit, Time now) {
  report_protocol(activity);
  report_motion(activity, now);
  report_wait(activity.waits_for, now);
  report_speed_limit(limit, now);
  report_denials(now);
  last_ = activity;
}

void AgentEventLogger::report_protocol(const AgentActivity& activity) {
  if (activity.is_superseded && !last_.is_superseded)
    events_.report(LogLevel::kWarning, robot_,
                   "superseded: a later agent drives this robot; this agent stays silent");
  if (!activity.is_superseded && last_.is_superseded)
    events_.report(LogLevel::kWarning, robot_, "no longer superseded: the robot obeys this agent");
  if (activity.is_fenced && !last_.is_fenced)
    events_.report(LogLevel::kInfo, robot_, "the robot obeys this agent (incarnation {})",
                   activity.incarnation);
  const bool was_registered = last_.is_registered && last_.epoch == activity.epoch;
  if (activity.is_registered && !was_registered)
    events_.report(LogLevel::kInfo, robot_, "registered in epoch {}", activity.epoch);
}

void AgentEventLogger::report_motion(const AgentActivity& activity, Time now) {
  if (activity.goal_index > last_.goal_index)
    events_.report(LogLevel::kInfo, robot_, "arrived at goal {}", last_.goal_index);
  if (activity.has_arrived && !last_.has_arrived)
    events_.report(LogLevel::kInfo, robot_, "arrived at goal {}, the last goal", activity.goal_index);
  if (activity.is_escaping && !last_.is_escaping && may_report(escape_reported_at_, now))
    events_.report(LogLevel::kInfo, robot_, "escaping from a conflict: no candidate has full clearance");
  // A robot beside a stranger turns too, but that is not why it stands.
  const bool is_in_deadlock = activity.is_recovering && !activity.stranger;
  if (is_in_deadlock && !was_in_deadlock_ && may_report(recovery_reported_at_, now))
    events_.report(LogLevel::kInfo, robot_, "blocked: turning right to resolve the deadlock");
  was_in_deadlock_ = is_in_deadlock;
  if (activity.stranger && !last_.stranger && may_report(stranger_reported_at_, now))
    events_.report(LogLevel::kInfo, robot_, "blocked: {}", to_text(*activity.stranger));
}

void AgentEventLogger::report_wait(WaitReason reason, Time now) {
  if (reason != waits_for_) {
    waits_for_ = reason;
    waits_since_ = now;
  }
  if (reason == reported_wait_ || now - waits_since_ < kSettlingTime) return;
  reported_wait_ = reason;
  if (reason == WaitReason::kNone)
    events_.report(LogLevel::kInfo, robot_, "no longer waiting");
  else
    events_.report(LogLevel::kInfo, robot_, "waiting for {}", to_text(reason));
}

void AgentEventLogger::report_speed_limit(const ClockSpeedLimit& limit, Time now) {
  // Without a measurement the agent waits, and the wait is reported instead.
  const bool is_limited = limit.offset && limit.speed_mps < limit.robot_limit_mps;
  if (is_limited != limited_since_.has_value())
    limited_since_ = is_limited ? std::optional(now) : std::nullopt;
  if (!is_limited) {
    if (limit.offset && std::exchange(reported_limit_mps_, 0) > 0)
      events_.report(LogLevel::kInfo, robot_, "the clocks no longer limit the speed");
    return;
  }
  const bool is_new = std::abs(limit.speed_mps - reported_limit_mps_) > kLimitChange * reported_limit_mps_;
  if (!is_new || now - *limited_since_ < kSettlingTime || !may_report(limit_reported_at_, now)) return;
  reported_limit_mps_ = limit.speed_mps;
  events_.report(LogLevel::kInfo, robot_,
                 "the clocks limit the speed to {:.2f} m/s: they differ by {:.2f} +- {:.2f} ms",
                 limit.speed_mps, to_seconds(limit.offset->middle()) * 1e3,
                 to_seconds(limit.offset->uncertainty()) * 1e3);
}

void AgentEventLogger::on_robot_report(const RobotReport& robot_report) {
  // Times of different incarnations of a robot are not compared.
  const bool is_same_incarnation = robot_report.robot_incarnation == robot_incarnation_;
  if (is_same_incarnation && robot_report.valid_at < latest_report_) return;  // overtaken by a later report
  latest_report_ = robot_report.valid_at;
  robot_incarnation_ = robot_report.robot_incarnation;
  report_restart(robot_report.activated);
  if (robot_report.is_off_reference && robot_report.executing.number > own_stop_) {
    own_stop_ = robot_report.executing.number;
    events_.report(LogLevel::kWarning, robot_,
                   "the robot is off its reference and makes its own stop (version {})", own_stop_);
  }
  if (was_off_reference_ && !robot_report.is_off_reference && !robot_report.is_lifted)
    events_.report(LogLevel::kInfo, robot_, "the robot is back on a granted version");
  was_off_reference_ = robot_report.is_off_reference;
  if (robot_report.is_lifted != was_lifted_)
    events_.report(LogLevel::kInfo, robot_, "the robot {}",
                   robot_report.is_lifted ? "is off the floor" : "has been put down");
  was_lifted_ = robot_report.is_lifted;
}

// A robot's counters restart from zero after a restart.
void AgentEventLogger::report_restart(std::uint64_t activated) {
  const bool has_restarted = activated < activated_;
  activated_ = activated;
  if (has_restarted) events_.report(LogLevel::kWarning, robot_, "the robot's firmware has restarted");
}

void AgentEventLogger::on_epoch(Epoch epoch, std::optional<std::uint32_t> coordinator) {
  if (coordinator)
    events_.report(LogLevel::kInfo, robot_, "adopted epoch {} of {}", epoch, process_name(*coordinator));
  else
    events_.report(LogLevel::kInfo, robot_, "adopted epoch {}, which the robot already obeys", epoch);
}

void AgentEventLogger::on_denial(const Verdict& verdict) {
  // Candidates may be denied for different reasons. The first candidate, the desired motion, counts.
  ++denials_[static_cast<std::size_t>(verdict.reasons.front())];
  ++denial_count_;
  if (verdict.reasons.front() == msg::Reason::REASON_CONFLICT) blocker_ = verdict.blockers.front();
}

void AgentEventLogger::report_denials(Time now) {
  if (denial_count_ == 0 || now - denials_reported_at_ < kMinInterval) return;
  denials_reported_at_ = now;
  denial_count_ = 0;
  const auto counts = std::exchange(denials_, {});
  if (!events_.is_wanted(LogLevel::kDebug)) return;
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const auto reason = static_cast<msg::Reason>(i);
    fmt::format_to(std::back_inserter(text), "{}{} x {}", text.empty() ? "" : ", ", counts[i],
                   to_text(reason));
    if (reason == msg::Reason::REASON_CONFLICT)
      fmt::format_to(std::back_inserter(text), " (last with robot {})", blocker_);
  }
  events_.report(LogLevel::kDebug, robot_, "proposals denied: {}", text);
}

}  // namespace sidestep
