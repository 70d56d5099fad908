// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/negotiation.hpp"

#include <algorithm>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

// Half a second ahead is as far as it goes.
constexpr int kLongestLead = 30;
// One version that comes too late is bad luck, two in a row are a slow network.
constexpr int kLateToSlowDown = 2;
constexpr int kTakenToSpeedUp = 10;

}  // namespace

Negotiation::Negotiation(RobotId robot, Incarnation incarnation)
    : robot_(robot), incarnation_(incarnation), next_number_(incarnation) {}

void Negotiation::on_feedback(const msg::Feedback& feedback) {
  if (feedback.robot() != robot_) return;
  if (feedback.obeyed_incarnation() > incarnation_) {
    superseded_ = true;
    return;
  }
  if (feedback.obeyed_incarnation() < incarnation_) return;  // says nothing about what this agent has sent
  const auto executing = decode(feedback.executing());
  if (!executing || executing->robot != robot_) {
    ++counts_.invalid;
    return;
  }
  if (!fenced_) {
    adopt(*executing);
    return;
  }
  const std::size_t before = held_.versions().size();
  const bool moved_on = executing->number != executing_;
  if (!held_.forget(executing->number, time_from_ns(feedback.at_ns()))) return;  // late
  executing_ = executing->number;
  if (moved_on) on_taken();
  // What went away is what was executed before, if the robot has moved on, and what the robot can never take.
  for (std::size_t gone = before - held_.versions().size() - (moved_on ? 1 : 0); gone > 0; --gone) {
    ++counts_.lost;
    on_late();
  }
  check_assumptions();
}

void Negotiation::adopt(const Version& executing) {
  fenced_ = true;
  held_.clear();
  held_.add(executing);
  executing_ = executing.number;
  next_number_ = std::max(next_number_, executing.number + 1);
}

void Negotiation::on_taken() {
  late_in_a_row_ = 0;
  if (++taken_in_a_row_ < kTakenToSpeedUp) return;
  taken_in_a_row_ = 0;
  lead_ = std::max(1, lead_ - 1);
}

void Negotiation::on_late() {
  taken_in_a_row_ = 0;
  if (++late_in_a_row_ < kLateToSlowDown) return;
  late_in_a_row_ = 0;
  lead_ = std::min(kLongestLead, lead_ + std::max(1, lead_ / 2));
}

bool Negotiation::is_settled_after(Time now) const {
  return (outstanding_ && outstanding_->start() > now) || base_at(Time::max()).trajectory.start() > now;
}

void Negotiation::check_assumptions() {
  if (outstanding_ && !held_.find(outstanding_->candidates.front().base)) {
    outstanding_.reset();
    contradicted_ = true;
  }
  for (const Version& version : held_.versions()) {
    if (version.number != executing_ && !held_.find(version.base)) contradicted_ = true;
  }
}

void Negotiation::on_coordinator_state(const msg::CoordinatorState& state) {
  if (state.epoch() < epoch_ || state.epoch() == 0) return;
  if (state.epoch() > epoch_) {
    epoch_ = state.epoch();
    unannounced_ = true;
    outstanding_.reset();
  }
  missing_ = std::ranges::find(state.missing(), robot_) != state.missing().end();
  granting_ = state.coordinator_phase() == msg::COORDINATOR_GRANTING;
}

msg::Registration Negotiation::registration() {
  unannounced_ = false;
  msg::Registration registration;
  registration.robot(robot_);
  registration.epoch(epoch_);
  registration.version_count(static_cast<std::uint8_t>(held_.versions().size()));
  std::ranges::transform(held_.versions(), registration.versions().begin(), encode);
  return registration;
}

const Version& Negotiation::base_at(Time start) const {
  const Version* current = &executing();
  for (bool found = true; found;) {
    found = false;
    for (const Version& next : held_.versions()) {
      if (next.base != current->number || next.number == current->number || next.trajectory.start() >= start)
        continue;
      current = &next;
      found = true;
      break;
    }
  }
  return *current;
}

msg::Proposal Negotiation::propose(std::span<const Trajectory> candidates, VersionNumber base, Time now) {
  contradicted_ = false;
  outstanding_.emplace();
  outstanding_->proposed_at = now;
  msg::Proposal proposal;
  proposal.robot(robot_);
  proposal.epoch(epoch_);
  proposal.candidate_count(static_cast<std::uint8_t>(candidates.size()));
  for (const Trajectory& trajectory : candidates) {
    Version& version = outstanding_->candidates[outstanding_->count];
    version = {robot_, incarnation_, next_number_++, base, trajectory};
    proposal.candidates()[outstanding_->count++] = encode(version);
  }
  ++counts_.proposals;
  counts_.cycles += static_cast<std::uint64_t>(lead_);
  return proposal;
}

std::optional<Version> Negotiation::on_verdict(const msg::Verdict& verdict, Time now) {
  if (superseded_ || verdict.robot() != robot_ || verdict.epoch() != epoch_ || !outstanding_ ||
      verdict.proposal_number() != outstanding_->number()) {
    return std::nullopt;
  }
  const Outstanding asked = *outstanding_;
  outstanding_.reset();
  last_round_trip_ = now - asked.proposed_at;
  if (verdict.granted() == 0) {
    ++counts_.denials;
    // The coordinator knows the robot from an earlier agent, but not this one: the registration was lost.
    if (verdict.reasons().front() == msg::REASON_NOT_ALL_REGISTERED) unannounced_ = true;
    return std::nullopt;
  }
  const auto end = asked.candidates.begin() + static_cast<std::ptrdiff_t>(asked.count);
  const auto granted = std::find_if(asked.candidates.begin(), end,
                                    [&](const Version& v) { return v.number == verdict.granted(); });
  if (granted == end) {
    ++counts_.invalid;
    return std::nullopt;
  }
  ++counts_.grants;
  if (granted->trajectory.start() <= now) {
    counts_.missed += static_cast<std::uint64_t>(lead_);
    on_late();
    return std::nullopt;
  }
  held_.add(*granted);
  return *granted;
}

void Negotiation::close_cycle(Time now) {
  if (!outstanding_ || outstanding_->start() > now) return;
  counts_.missed += static_cast<std::uint64_t>(lead_);
  on_late();
  // The verdict may still come; it is too late to be forwarded.
  outstanding_.reset();
}

}  // namespace sidestep
