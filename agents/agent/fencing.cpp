// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/fencing.hpp"

namespace sidestep {
namespace {

// After this many consecutive reports of the robot's earlier incarnation, the report of a later incarnation
// must have been false: delayed reports are never this many.
constexpr int kMaxDelayedReports = 60;
// If two agents choose new incarnations above the same incarnation, they add different increments below this
// bound.
constexpr Incarnation kIncarnationSpread = 1'000'003;
constexpr Duration kQueryAfterSilence{500'000'000};

}  // namespace

// The clock of a later incarnation may be behind. A single false report must not exclude all true reports
// permanently.
void Fencing::update_incarnation(const RobotReport& robot_report, ReportUse& use) {
  const bool is_earlier = robot_report.robot_incarnation < robot_incarnation_;
  if (is_earlier && ++reports_of_earlier_incarnation_ < kMaxDelayedReports) return;
  reports_of_earlier_incarnation_ = 0;
  use.is_current = true;
  if (robot_report.robot_incarnation == robot_incarnation_) return;
  use.is_new_incarnation = true;
  robot_incarnation_ = robot_report.robot_incarnation;
  if (superseded_at_) superseded_at_ = Time::min();
}

// Once the robot has obeyed this agent, it yields to a later agent. Before that, a report with a higher
// incarnation means that this agent's clock is behind an earlier agent's clock.
void Fencing::on_later_agent(const RobotReport& robot_report, bool is_current) {
  const Time at = is_current ? robot_report.valid_at : Time::min();
  if (is_fenced())
    superseded_at_ = std::max(superseded_at_.value_or(at), at);
  else
    incarnation_ = robot_report.obeyed_incarnation + 1 + incarnation_ % kIncarnationSpread;
}

Fencing::ReportUse Fencing::on_robot_report(const RobotReport& robot_report) {
  cycles_since_report_ = 0;
  ReportUse use;
  update_incarnation(robot_report, use);
  if (robot_report.obeyed_incarnation > incarnation_) {
    on_later_agent(robot_report, use.is_current);
    return use;
  }
  if (robot_report.obeyed_incarnation < incarnation_) return use;
  use.is_acknowledged = true;
  // A robot never returns to an earlier agent, so a later report that acknowledges this agent proves that the
  // report about another agent was false.
  if (superseded_at_ && use.is_current && robot_report.valid_at > *superseded_at_) superseded_at_.reset();
  cycles_since_acknowledgement_ = 0;
  robot_epoch_ = std::max(robot_epoch_, robot_report.obeyed_epoch);
  use.is_first = !is_fenced() && use.is_current;
  if (use.is_first) {
    fenced_at_ = robot_report.valid_at;
    former_epoch_ = robot_report.obeyed_epoch;
  }
  return use;
}

bool Fencing::must_query_robot(Duration cycle) const {
  return is_superseded() && cycles_since_report_ * cycle > kQueryAfterSilence;
}

void Fencing::close_cycle() {
  ++cycles_since_report_;
  ++cycles_since_acknowledgement_;
}

}  // namespace sidestep
