// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/negotiation.hpp"

#include <utility>

namespace sidestep {
namespace {

// An agent that knows no epoch waits this long for its coordinator to start.
constexpr Duration kMaxStartTime{2'000'000'000};
// Number of cycles beyond its lead for which an agent keeps proposing without hearing from its robot. It is
// limited because a robot without power rolls on while others rely on its versions.
constexpr int kMaxSilentCycles = 1;

}  // namespace

Negotiation::Negotiation(RobotId robot, Incarnation incarnation, Duration cycle)
    : robot_(robot), cycle_(cycle), fencing_(incarnation), held_(incarnation), pacing_(cycle) {}

void Negotiation::on_robot_report(const RobotReport& robot_report) {
  const Fencing::ReportUse use = fencing_.on_robot_report(robot_report);
  if (use.is_new_incarnation) held_.forget_report_times();
  if (!use.is_acknowledged) return;
  pacing_.set_robot_lead(robot_report.lead);
  if (fencing_.robot_epoch() > epoch_) adopt_epoch(fencing_.robot_epoch());
  if (use.is_first)
    held_.begin(robot_report);
  else if (is_fenced())
    apply_report(robot_report, use.is_current);
}

void Negotiation::apply_report(const RobotReport& robot_report, bool is_current) {
  const HeldVersions::ReportEffect effect = held_.apply(robot_report, is_current);
  counts_.late_reports += effect.is_late;
  if (effect.is_late) return;
  if (effect.is_unknown) {
    proposals_.close();
    contradicted_ = true;
    return;
  }
  if (effect.has_switched) pacing_.on_version_taken();
  for (int i = 0; i < effect.lost; ++i) pacing_.on_version_late();
  counts_.lost += static_cast<std::uint64_t>(effect.lost);
  contradicted_ |= proposals_.close_unreachable(held_);
  contradicted_ |= held_.has_unreachable();
}

void Negotiation::adopt_epoch(Epoch epoch) {
  epoch_ = epoch;
  registration_pending_ = true;
  contact_.on_epoch();
  proposals_.discard();
  pacing_.reset();
}

void Negotiation::on_coordinator_state(const CoordinatorHeartbeat& heartbeat, Time now) {
  if (heartbeat.epoch == 0) return;  // the coordinator is on standby
  if (heartbeat.epoch < epoch_) {
    ++counts_.old_epochs;
    // This coordinator does not know the highest epoch, and no other coordinator is alive: a registration
    // informs it of the epoch.
    if (!contact_.is_heard(now)) registration_pending_ = true;
    return;
  }
  if (heartbeat.epoch > epoch_) adopt_epoch(heartbeat.epoch);
  contact_.on_heartbeat(heartbeat, robot_, now);
}

bool Negotiation::needs_other_coordinator(Time now) const {
  if (!is_fenced() || is_superseded() || fencing_.robot_epoch() != epoch_) return false;
  if (epoch_ == 0) return now - *fencing_.fenced_at() >= kMaxStartTime;
  return contact_.is_failing(now);
}

WaitReason Negotiation::wait_reason(Time now) const {
  if (!is_fenced()) return WaitReason::kNotFenced;
  if (is_superseded()) return WaitReason::kSuperseded;
  if (epoch_ == 0 || !contact_.is_heard(now)) return WaitReason::kNoCoordinator;
  if (fencing_.robot_epoch() != epoch_) return WaitReason::kEpochNotObeyed;
  if (registration_pending_) return WaitReason::kNotRegistered;
  if (!contact_.is_granting())
    return contact_.is_robot_missing() ? WaitReason::kNotRegistered : WaitReason::kOthersNotRegistered;
  if (fencing_.cycles_since_acknowledgement() > lead() + kMaxSilentCycles) return WaitReason::kRobotSilent;
  if (held_.is_full()) return WaitReason::kTooManyVersions;
  return WaitReason::kNone;
}

bool Negotiation::has_upcoming_version(Time now) const {
  return proposals_.has_upcoming(now) || held_.last_start(now) > now;
}

std::optional<Time> Negotiation::retry_start(Time now) const {
  if (held_.last_start(now) > now) return std::nullopt;
  return proposals_.start_to_retry(now, pacing_.answer_timeout(), cycle_);
}

Registration Negotiation::registration() {
  registration_pending_ = false;
  Registration registration{robot_, incarnation(), epoch_, Time{}, held_.versions()};
  const Epoch former = fencing_.former_epoch();
  registration.has_moved = former != 0 && former != epoch_;
  return registration;
}

Proposal Negotiation::propose(std::span<const Trajectory> candidates, VersionNumber base, Time now,
                              const std::optional<Intent>& intent) {
  contradicted_ = false;
  SentProposal& sent = proposals_.add(candidates.front().start(), now, lead());
  if (proposals_.attempts() == 1) counts_.cycles += static_cast<std::uint64_t>(lead());
  ++counts_.proposals;
  on_request(now);

  Proposal proposal{robot_, incarnation(), epoch_, Time{}, held_.next_number(), candidates.size()};
  for (const Trajectory& trajectory : candidates) {
    Version& version = sent.candidates[sent.count];
    version = {robot_, incarnation(), held_.take_number(), base, trajectory, 0, intent};
    proposal.candidates[sent.count++] = version;
  }
  return proposal;
}

Negotiation::VerdictResult Negotiation::on_verdict(const Verdict& verdict, Time now) {
  if (is_superseded() || verdict.epoch != epoch_) {
    ++counts_.unexpected_verdicts;
    return {};
  }
  contact_.on_verdict(verdict, now);
  SentProposal* const sent = proposals_.find_unanswered(verdict.proposal_number);
  if (!sent) {
    // The answer to a registration has no proposal number.
    counts_.unexpected_verdicts += verdict.proposal_number != 0;
    return {};
  }
  sent->is_answered = true;
  const Duration round_trip = now - sent->proposed_at;
  pacing_.on_round_trip(round_trip);
  if (verdict.granted_version == 0) {
    sent->is_open = false;
    ++counts_.denials;
    // The coordinator knows an earlier agent of the robot but not this agent: the registration was lost.
    if (verdict.reasons.front() == msg::Reason::REASON_NOT_ALL_REGISTERED) registration_pending_ = true;
    return {std::nullopt, round_trip};
  }
  return apply_grant(*sent, verdict, now);
}

Negotiation::VerdictResult Negotiation::apply_grant(SentProposal& sent, const Verdict& verdict, Time now) {
  const Version* const granted = sent.find(verdict.granted_version);
  const bool was_open = std::exchange(sent.is_open, false);
  if (!granted) {
    ++counts_.unproposed_grants;
    return {};
  }
  const Duration round_trip = now - sent.proposed_at;
  ++counts_.grants;
  if (!was_open || held_.is_full()) return {std::nullopt, round_trip};
  if (granted->trajectory.start() <= now) {
    sent.is_open = true;  // close_cycle() counts it as missed
    return {std::nullopt, round_trip};
  }
  proposals_.close();
  held_.add(*granted);
  return {*granted, round_trip};
}

void Negotiation::close_cycle(Time now) {
  fencing_.close_cycle();
  const int missed = proposals_.close_started(now);
  counts_.missed += static_cast<std::uint64_t>(missed);
  if (missed > 0) pacing_.on_version_late();
}

}  // namespace sidestep
