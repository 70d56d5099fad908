// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/negotiation.hpp"

#include <algorithm>
#include <utility>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

// A coordinator that has not been heard for so long grants nothing.
constexpr Duration kSilence{500'000'000};
constexpr int kMostAskedForStart = 4;
// So that two agents which begin above the same one do not become one.
constexpr Incarnation kSpread = 1'000'003;

}  // namespace

Negotiation::Negotiation(RobotId robot, Incarnation incarnation, Duration cycle)
    : robot_(robot), incarnation_(incarnation), cycle_(cycle), next_number_(incarnation), pacing_(cycle) {}

void Negotiation::on_feedback(const msg::Feedback& feedback) {
  if (feedback.robot() != robot_) return;
  if (feedback.obeyed_incarnation() > incarnation_) {
    // Once obeyed, an agent yields to a later one. Before, its clock is behind an earlier agent's.
    if (fenced_) superseded_ = true;
    if (!fenced_) incarnation_ = feedback.obeyed_incarnation() + 1 + incarnation_ % kSpread;
    return;
  }
  if (feedback.obeyed_incarnation() < incarnation_) return;  // says nothing about what this agent has sent
  const auto executing = decode(feedback.executing());
  if (!executing || executing->robot != robot_ || feedback.obeyed_epoch() > kHighestEpoch) {
    ++counts_.invalid;
    return;
  }
  robot_epoch_ = std::max<Epoch>(robot_epoch_, feedback.obeyed_epoch());
  if (robot_epoch_ > epoch_) adopt_epoch(robot_epoch_);
  if (!fenced_) {
    adopt(feedback, *executing);
    return;
  }
  use_fact(feedback, *executing);
}

void Negotiation::use_fact(const msg::Feedback& feedback, const Version& executing) {
  const Time at = time_from_ns(feedback.at_ns());
  const std::size_t before = held_.versions().size();
  const bool moved_on = executing.number != executing_;
  if (feedback.is_lifted() && executing.number == 0) {
    if (at < latest_fact_) return;
    held_.forget_started(at);
    executing_ = 0;
  } else if (held_.forget(executing.number, at)) {
    executing_ = executing.number;
    if (moved_on) pacing_.on_taken();
  } else {
    const auto is_older = [&](const Version& held) { return held.number < executing.number; };
    if (!std::ranges::any_of(held_.versions(), is_older)) return;  // late
    return rebase(executing);
  }
  latest_fact_ = std::max(latest_fact_, at);
  // What went away is what was executed before, if the robot has moved on, and what the robot can never take.
  for (std::size_t gone = before - held_.versions().size(); gone > (moved_on ? 1 : 0); --gone) {
    ++counts_.lost;
    pacing_.on_late();
  }
  check_assumptions();
}

void Negotiation::rebase(const Version& executing) {
  held_.clear();
  held_.add(executing);
  executing_ = executing.number;
  next_number_ = std::max(next_number_, executing.number + 1);
  close_all();
  contradicted_ = true;
}

void Negotiation::adopt(const msg::Feedback& feedback, const Version& executing) {
  fenced_ = true;
  held_.clear();
  const bool is_absent = feedback.is_lifted() && executing.number == 0;
  if (!is_absent) held_.add(executing);
  executing_ = executing.number;
  next_number_ = std::max({next_number_, feedback.obeyed_incarnation(), executing.number + 1});
}

void Negotiation::adopt_epoch(Epoch epoch) {
  epoch_ = epoch;
  unannounced_ = true;
  granting_ = false;
  close_all();
  for (Asked& asked : asked_) asked.answered = true;
  pacing_.reset();
}

void Negotiation::close_all() {
  for (Asked& asked : asked_) asked.open = false;
}

bool Negotiation::rests_on(const Version& version) const {
  return held_.find(version.base) || (is_absent() && version.base == 0);
}

void Negotiation::check_assumptions() {
  for (Asked& asked : asked_) {
    if (!asked.open || rests_on(asked.candidates.front())) continue;
    asked.open = false;
    contradicted_ = true;
  }
  for (const Version& version : held_.versions()) {
    if (version.number != executing_ && !rests_on(version)) contradicted_ = true;
  }
}

void Negotiation::on_coordinator_state(const msg::CoordinatorState& state, Time now) {
  if (state.epoch() == 0) return;  // a standby
  if (!is_believable(state.epoch(), now)) {
    ++counts_.invalid;
    return;
  }
  if (state.epoch() < epoch_) {
    // A coordinator that does not know how far epochs have come, and no other is alive: the registration
    // tells it.
    if (now - heard_ > kSilence) unannounced_ = true;
    return;
  }
  if (state.epoch() > epoch_) adopt_epoch(state.epoch());
  heard_ = now;
  missing_ = std::ranges::find(state.missing(), robot_) != state.missing().end();
  granting_ = state.coordinator_mode() == msg::COORDINATOR_GRANTING;
}

bool Negotiation::may_propose(Time now) const {
  return fenced_ && !superseded_ && robot_epoch_ == epoch_ && !unannounced_ && granting_ &&
         now - heard_ < kSilence && !held_.is_full();
}

bool Negotiation::is_settled_after(Time now) const {
  const auto decides = [&](const Asked& asked) { return asked.open && asked.start() > now; };
  return std::ranges::any_of(asked_, decides) || last_start() > now;
}

Time Negotiation::last_start() const {
  if (!is_absent()) return base_at(Time::max()).trajectory.start();
  return held_.versions().empty() ? Time::min() : held_.versions().back().trajectory.start();
}

std::optional<Time> Negotiation::unanswered_start(Time now) const {
  if (asked_count_ == 0 || asked_for_start_ >= kMostAskedForStart || last_start() > now) return std::nullopt;
  const Asked& last = newest();
  const bool is_due = last.open && now - last.proposed_at >= pacing_.patience() && last.start() - now > cycle_;
  return is_due ? std::optional(last.start()) : std::nullopt;
}

msg::Registration Negotiation::registration() {
  unannounced_ = false;
  msg::Registration registration;
  registration.robot(robot_);
  registration.epoch(epoch_);
  registration.is_absent(held_.versions().empty());
  registration.version_count(static_cast<std::uint8_t>(held_.versions().size()));
  std::ranges::transform(held_.versions(), registration.versions().begin(), encode);
  return registration;
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

msg::Proposal Negotiation::propose(std::span<const Trajectory> candidates, VersionNumber base, Time now,
                                   double inflation_m, const std::optional<Intent>& intent) {
  contradicted_ = false;
  const bool is_again = asked_count_ > 0 && newest().start() == candidates.front().start();
  asked_for_start_ = is_again ? asked_for_start_ + 1 : 1;
  if (!is_again) counts_.cycles += static_cast<std::uint64_t>(lead());
  ++counts_.proposals;

  Asked& asked = asked_[asked_count_++ % asked_.size()];
  asked.count = 0;
  asked.proposed_at = now;
  asked.lead = lead();
  asked.answered = false;
  asked.open = true;
  msg::Proposal proposal;
  proposal.robot(robot_);
  proposal.epoch(epoch_);
  proposal.candidate_count(static_cast<std::uint8_t>(candidates.size()));
  for (const Trajectory& trajectory : candidates) {
    Version& version = asked.candidates[asked.count];
    version = {robot_, incarnation_, next_number_++, base, trajectory, inflation_m, intent};
    proposal.candidates()[asked.count++] = encode(version);
  }
  return proposal;
}

std::optional<Version> Negotiation::on_verdict(const msg::Verdict& verdict, Time now) {
  if (superseded_ || verdict.robot() != robot_ || verdict.epoch() != epoch_) return std::nullopt;
  const auto asked = std::ranges::find_if(
      asked_, [&](const Asked& a) { return !a.answered && a.number() == verdict.proposal_number(); });
  if (asked == asked_.end()) return std::nullopt;
  const bool was_open = std::exchange(asked->open, false);
  asked->answered = true;
  last_round_trip_ = now - asked->proposed_at;
  pacing_.on_round_trip(last_round_trip_);
  if (verdict.granted() == 0) {
    ++counts_.denials;
    // The coordinator knows the robot from an earlier agent, but not this one: the registration was lost.
    if (verdict.reasons().front() == msg::REASON_NOT_ALL_REGISTERED) unannounced_ = true;
    return std::nullopt;
  }
  const auto end = asked->candidates.begin() + static_cast<std::ptrdiff_t>(asked->count);
  const auto granted = std::find_if(asked->candidates.begin(), end,
                                    [&](const Version& v) { return v.number == verdict.granted(); });
  if (granted == end) {
    ++counts_.invalid;
    return std::nullopt;
  }
  ++counts_.grants;
  if (!was_open || held_.is_full()) return std::nullopt;
  if (granted->trajectory.start() <= now) {
    asked->open = true;  // to be counted with the cycle
    return std::nullopt;
  }
  close_all();
  held_.add(*granted);
  return *granted;
}

void Negotiation::close_cycle(Time now) {
  int missed = 0;
  for (Asked& asked : asked_) {
    if (!asked.open || asked.start() > now) continue;
    // The verdict may still come; it is too late to be forwarded.
    asked.open = false;
    missed = asked.lead;
  }
  if (missed == 0) return;
  counts_.missed += static_cast<std::uint64_t>(missed);
  pacing_.on_late();
}

}  // namespace sidestep
