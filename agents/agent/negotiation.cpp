// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/negotiation.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

// A coordinator that has been silent for longer than this does not count as granting.
constexpr Duration kCoordinatorTimeout{500'000'000};
// After this time an answer to a request is overdue, even on slow networks.
constexpr Duration kMaxAnswerTime{400'000'000};
// An agent that knows no epoch waits for its coordinator to start.
constexpr Duration kMaxStartTime{2'000'000'000};
// A version that starts later than this was proposed by a wrong clock.
constexpr Duration kMaxAhead{2'000'000'000};
// Number of consecutive facts of the robot's earlier incarnation after which the fact of the later one must
// have been false. Delayed facts are fewer.
constexpr int kFactsOfOneIncarnation = 60;
constexpr int kMaxProposalsPerStart = 4;
// Number of cycles beyond its lead for which an agent proposes although it hears nothing from its robot. It
// is limited because a robot without power rolls on while others rely on its versions.
constexpr int kMaxSilentCycles = 1;
// If two agents both restart above the same incarnation, they add different increments below this bound.
constexpr Incarnation kIncarnationSpread = 1'000'003;

}  // namespace

Negotiation::Negotiation(RobotId robot, Incarnation incarnation, Duration cycle)
    : robot_(robot), incarnation_(incarnation), cycle_(cycle), next_number_(incarnation), pacing_(cycle) {}

// A later incarnation's clock may be behind. A single false fact must not exclude all true ones permanently.
bool Negotiation::update_incarnation(const Feedback& feedback) {
  if (feedback.robot_incarnation == robot_incarnation_) {
    facts_of_earlier_incarnation_ = 0;
    return true;
  }
  const bool is_earlier = feedback.robot_incarnation < robot_incarnation_;
  if (is_earlier && ++facts_of_earlier_incarnation_ < kFactsOfOneIncarnation) return false;
  robot_incarnation_ = feedback.robot_incarnation;
  facts_of_earlier_incarnation_ = 0;
  latest_fact_ = Time::min();
  if (superseded_at_) superseded_at_ = Time::min();
  return true;
}

void Negotiation::on_feedback(const Feedback& feedback) {
  unheard_cycles_ = 0;
  const bool is_current = update_incarnation(feedback);
  if (feedback.obeyed_incarnation > incarnation_) {
    // An agent that the robot has obeyed yields to a later one. Until then, a higher incarnation means that
    // this agent's clock is behind an earlier agent's.
    const Time at = is_current ? feedback.valid_at : Time::min();
    if (fenced_) superseded_at_ = std::max(superseded_at_.value_or(at), at);
    if (!fenced_) incarnation_ = feedback.obeyed_incarnation + 1 + incarnation_ % kIncarnationSpread;
    return;
  }
  if (feedback.obeyed_incarnation < incarnation_) return;  // does not acknowledge this agent
  // A robot never returns to an earlier agent, so a later fact that acknowledges this agent proves that the
  // fact about another agent was false.
  if (superseded_at_ && is_current && feedback.valid_at > *superseded_at_) superseded_at_.reset();
  silent_cycles_ = 0;
  pacing_.set_robot_lead(feedback.lead);
  robot_epoch_ = std::max(robot_epoch_, feedback.obeyed_epoch);
  if (robot_epoch_ > epoch_) adopt_epoch(robot_epoch_);
  if (!fenced_) {
    if (is_current) finish_fencing(feedback);
    return;
  }
  apply_fact(feedback, is_current);
}

void Negotiation::apply_fact(const Feedback& feedback, bool is_current) {
  const Version& executing = feedback.executing;
  const Time at = feedback.valid_at;
  const std::size_t before = held_.versions().size();
  const bool has_advanced = executing.number != executing_;
  if (feedback.is_absent()) {
    if (!is_current || at < latest_fact_) {
      ++counts_.late_facts;
      return;
    }
    held_.forget_started(at);
    executing_ = 0;
    number_above(executing);
  } else if (held_.forget(executing.number, at)) {
    executing_ = executing.number;
    if (has_advanced) pacing_.on_version_taken();
  } else {
    // A later fact about an older version proves that an earlier fact was false: robots never return to older
    // versions.
    const auto is_older = [&](const Version& held) { return held.number < executing.number; };
    if (!std::ranges::any_of(held_.versions(), is_older) && (!is_current || at <= latest_fact_)) {
      ++counts_.late_facts;
      return;
    }
    if (is_current) latest_fact_ = std::max(latest_fact_, at);
    return rebase(executing);
  }
  if (is_current) latest_fact_ = std::max(latest_fact_, at);
  // If the robot has advanced, one removed version is the one that it executed before. All others were lost:
  // the robot can no longer switch to them.
  for (std::size_t gone = before - held_.versions().size(); gone > (has_advanced ? 1 : 0); --gone) {
    ++counts_.lost;
    pacing_.on_version_late();
  }
  check_assumptions();
}

void Negotiation::rebase(const Version& executing) {
  held_.clear();
  held_.add(executing);
  executing_ = executing.number;
  number_above(executing);
  close_proposals();
  contradicted_ = true;
}

void Negotiation::finish_fencing(const Feedback& feedback) {
  fenced_ = true;
  former_epoch_ = feedback.obeyed_epoch;
  held_.clear();
  if (!feedback.is_absent()) held_.add(feedback.executing);
  executing_ = feedback.executing.number;
  latest_fact_ = feedback.valid_at;
  fenced_at_ = feedback.valid_at;
  next_number_ = std::max(next_number_, feedback.obeyed_incarnation);
  number_above(feedback.executing);
}

// A robot off the floor reports its last version as the base, because the stop that it made before it was
// lifted may never have been reported.
void Negotiation::number_above(const Version& executing) {
  next_number_ = std::max({next_number_, executing.number + 1, executing.base + 1});
}

void Negotiation::adopt_epoch(Epoch epoch) {
  epoch_ = epoch;
  registration_pending_ = true;
  granting_ = false;
  unanswered_since_.reset();
  unknown_since_.reset();
  close_proposals();
  for (SentProposal& sent : proposals_) sent.answered = true;
  pacing_.reset();
}

void Negotiation::close_proposals() {
  for (SentProposal& sent : proposals_) sent.open = false;
}

bool Negotiation::has_base_of(const Version& version) const {
  return held_.find(version.base) || (is_absent() && version.base == 0);
}

void Negotiation::check_assumptions() {
  for (SentProposal& sent : proposals_) {
    if (!sent.open || has_base_of(sent.candidates.front())) continue;
    sent.open = false;
    contradicted_ = true;
  }
  for (const Version& version : held_.versions()) {
    if (version.number != executing_ && !has_base_of(version)) contradicted_ = true;
  }
}

void Negotiation::on_coordinator_state(const CoordinatorHeartbeat& heartbeat, Time now) {
  if (heartbeat.epoch == 0) return;  // the coordinator is a standby
  if (heartbeat.epoch < epoch_) {
    ++counts_.old_epochs;
    // This coordinator does not know the highest epoch, and no other coordinator is alive: a registration
    // informs it of the epoch.
    if (!hears_coordinator(now)) registration_pending_ = true;
    return;
  }
  if (heartbeat.epoch > epoch_) adopt_epoch(heartbeat.epoch);
  last_heartbeat_at_ = now;
  missing_ = is_missing(heartbeat, robot_);
  granting_ = heartbeat.mode == msg::CoordinatorMode::COORDINATOR_GRANTING;
}

// A time far in the future means that a clock has been set.
bool Negotiation::hears_coordinator(Time now) const {
  return std::chrono::abs(now - last_heartbeat_at_) < kCoordinatorTimeout;
}

bool Negotiation::is_unserved(Time now) const {
  const auto lasts = [=](const std::optional<Time>& since, Duration limit) {
    return since && now - *since >= limit;
  };
  if (!fenced_ || is_superseded() || robot_epoch_ != epoch_) return false;
  if (epoch_ == 0) return lasts(fenced_at_, kMaxStartTime);
  return !hears_coordinator(now) || lasts(unanswered_since_, kMaxAnswerTime) ||
         lasts(unknown_since_, kMaxAnswerTime);
}

WaitReason Negotiation::wait_reason(Time now) const {
  if (!fenced_) return WaitReason::kNotFenced;
  if (is_superseded()) return WaitReason::kSuperseded;
  if (epoch_ == 0 || !hears_coordinator(now)) return WaitReason::kNoCoordinator;
  if (robot_epoch_ != epoch_) return WaitReason::kEpochNotObeyed;
  if (registration_pending_) return WaitReason::kNotRegistered;
  if (!granting_) return missing_ ? WaitReason::kNotRegistered : WaitReason::kOthersNotRegistered;
  if (silent_cycles_ > lead() + kMaxSilentCycles) return WaitReason::kRobotSilent;
  if (held_.is_full()) return WaitReason::kTooManyVersions;
  return WaitReason::kNone;
}

bool Negotiation::has_upcoming_version(Time now) const {
  const auto is_pending = [&](const SentProposal& sent) {
    return sent.open && sent.start() > now && sent.start() <= now + kMaxAhead;
  };
  return std::ranges::any_of(proposals_, is_pending) || last_start(now) > now;
}

Time Negotiation::last_start(Time now) const {
  if (!is_absent()) return base_at(now + kMaxAhead).trajectory.start();
  Time last = Time::min();
  for (const Version& version : held_.versions())
    if (version.trajectory.start() <= now + kMaxAhead) last = std::max(last, version.trajectory.start());
  return last;
}

std::optional<Time> Negotiation::retry_start(Time now) const {
  if (proposal_count_ == 0 || proposals_for_start_ >= kMaxProposalsPerStart || last_start(now) > now)
    return std::nullopt;
  const SentProposal& last = newest_proposal();
  const bool is_due =
      last.open && now - last.proposed_at >= pacing_.answer_timeout() && last.start() - now > cycle_;
  return is_due ? std::optional(last.start()) : std::nullopt;
}

Registration Negotiation::registration() {
  registration_pending_ = false;
  return {robot_, incarnation_, epoch_, Time{}, held_};
}

void Negotiation::on_request(Time now) {
  if (!unanswered_since_ || *unanswered_since_ > now) unanswered_since_ = now;
}

const Version& Negotiation::base_at(Time start) const {
  const Version* current = &executing();
  const auto follows = [&](const Version& next) {
    return next.base == current->number && next.number != current->number && next.trajectory.start() < start;
  };
  for (;;) {
    const auto next = std::ranges::find_if(held_.versions(), follows);
    if (next == held_.versions().end()) return *current;
    current = &*next;
  }
}

Proposal Negotiation::propose(std::span<const Trajectory> candidates, VersionNumber base, Time now,
                              const std::optional<Intent>& intent) {
  contradicted_ = false;
  const bool is_again = proposal_count_ > 0 && newest_proposal().start() == candidates.front().start();
  proposals_for_start_ = is_again ? proposals_for_start_ + 1 : 1;
  if (!is_again) counts_.cycles += static_cast<std::uint64_t>(lead());
  ++counts_.proposals;
  on_request(now);

  SentProposal& sent = proposals_[proposal_count_++ % proposals_.size()];
  sent.count = 0;
  sent.proposed_at = now;
  sent.lead = lead();
  sent.answered = false;
  sent.open = true;
  Proposal proposal{robot_, incarnation_, epoch_, Time{}, next_number_, candidates.size()};
  for (const Trajectory& trajectory : candidates) {
    Version& version = sent.candidates[sent.count];
    version = {robot_, incarnation_, next_number_++, base, trajectory, 0, intent};
    proposal.candidates[sent.count++] = version;
  }
  return proposal;
}

Negotiation::VerdictResult Negotiation::on_verdict(const Verdict& verdict, Time now) {
  if (is_superseded() || verdict.epoch != epoch_) {
    ++counts_.unexpected_verdicts;
    return {};
  }
  unanswered_since_.reset();
  if (verdict.proposal_number != 0) observe_knowledge(verdict, now);
  const auto sent = std::ranges::find_if(proposals_, [&](const SentProposal& a) {
    return !a.answered && a.number() == verdict.proposal_number;
  });
  if (sent == proposals_.end()) {
    // The answer to a registration has no proposal number.
    counts_.unexpected_verdicts += verdict.proposal_number != 0;
    return {};
  }
  const bool was_open = std::exchange(sent->open, false);
  sent->answered = true;
  const Duration round_trip = now - sent->proposed_at;
  pacing_.on_round_trip(round_trip);
  if (verdict.granted_version == 0) {
    ++counts_.denials;
    // The coordinator knows an earlier agent of the robot but not this one: the registration was lost.
    if (verdict.reasons.front() == msg::Reason::REASON_NOT_ALL_REGISTERED) registration_pending_ = true;
    return {std::nullopt, round_trip};
  }
  const auto end = sent->candidates.begin() + static_cast<std::ptrdiff_t>(sent->count);
  const auto granted = std::find_if(sent->candidates.begin(), end,
                                    [&](const Version& v) { return v.number == verdict.granted_version; });
  if (granted == end) {
    ++counts_.unproposed_grants;
    return {};
  }
  ++counts_.grants;
  if (!was_open || held_.is_full()) return {std::nullopt, round_trip};
  if (granted->trajectory.start() <= now) {
    sent->open = true;  // close_cycle() counts it as missed
    return {std::nullopt, round_trip};
  }
  close_proposals();
  held_.add(*granted);
  return {*granted, round_trip};
}

// If a coordinator does not hear the robot, its list of the robot's versions fills up, and it does not know
// the latest ones.
void Negotiation::observe_knowledge(const Verdict& verdict, Time now) {
  const msg::Reason reason = verdict.reasons.front();
  const bool is_unknown =
      reason == msg::Reason::REASON_LEDGER_FULL || reason == msg::Reason::REASON_BASE_UNKNOWN;
  if (!is_unknown)
    unknown_since_.reset();
  else if (!unknown_since_ || *unknown_since_ > now)
    unknown_since_ = now;
}

void Negotiation::close_cycle(Time now) {
  ++silent_cycles_;
  ++unheard_cycles_;
  int missed = 0;
  for (SentProposal& sent : proposals_) {
    if (!sent.open || sent.start() > now) continue;
    // A verdict may still arrive, but too late to be forwarded.
    sent.open = false;
    missed = sent.lead;
  }
  if (missed == 0) return;
  counts_.missed += static_cast<std::uint64_t>(missed);
  pacing_.on_version_late();
}

}  // namespace sidestep
