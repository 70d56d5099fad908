// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/coordinator_contact.hpp"

#include <chrono>

namespace sidestep {
namespace {

// A coordinator that has been silent for longer than this does not count as granting.
constexpr Duration kCoordinatorTimeout{500'000'000};
// After this time an answer to a request is overdue, even on slow networks.
constexpr Duration kMaxAnswerTime{400'000'000};

/// Sets `since` to `now` unless it holds an earlier time. A future time means that a clock has been set.
void begin(std::optional<Time>& since, Time now) {
  if (!since || *since > now) since = now;
}

}  // namespace

void CoordinatorContact::on_epoch() {
  is_granting_ = false;
  unanswered_since_.reset();
  unknown_since_.reset();
}

void CoordinatorContact::on_heartbeat(const CoordinatorHeartbeat& heartbeat, RobotId robot, Time now) {
  last_heartbeat_at_ = now;
  is_robot_missing_ = is_missing(heartbeat, robot);
  is_granting_ = heartbeat.mode == msg::CoordinatorMode::COORDINATOR_GRANTING;
}

void CoordinatorContact::on_request(Time now) { begin(unanswered_since_, now); }

void CoordinatorContact::on_verdict(const Verdict& verdict, Time now) {
  unanswered_since_.reset();
  if (verdict.proposal_number == 0) return;
  // If a coordinator does not hear the robot, its list of the robot's versions fills up, and the coordinator
  // does not know the latest versions.
  const msg::Reason reason = verdict.reasons.front();
  if (reason == msg::Reason::REASON_LEDGER_FULL || reason == msg::Reason::REASON_BASE_UNKNOWN)
    begin(unknown_since_, now);
  else
    unknown_since_.reset();
}

// A time far in the future means that a clock has been set.
bool CoordinatorContact::is_heard(Time now) const {
  return std::chrono::abs(now - last_heartbeat_at_) < kCoordinatorTimeout;
}

bool CoordinatorContact::is_failing(Time now) const {
  const auto is_overdue = [=](const std::optional<Time>& since) {
    return since && now - *since >= kMaxAnswerTime;
  };
  return !is_heard(now) || is_overdue(unanswered_since_) || is_overdue(unknown_since_);
}

}  // namespace sidestep
