// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/grant_audit.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sidestep {
namespace {

/// Whether the candidates that a verdict does not grant are denied permanently.
bool is_final(const msg::Verdict& verdict) {
  if (verdict.granted_version() != 0) return true;
  switch (verdict.reasons().front()) {
    case msg::Reason::REASON_NOT_CONTINUOUS:
    case msg::Reason::REASON_BEYOND_LIMITS:
    case msg::Reason::REASON_NOT_AT_REST:
    case msg::Reason::REASON_OUTSIDE_FIELD:
    case msg::Reason::REASON_OBSTACLE:
    case msg::Reason::REASON_CONFLICT:
      return true;
    default:
      return false;  // a later copy of the proposal may be granted
  }
}

}  // namespace

void GrantAudit::on_proposal(AuditedRobot& robot, const msg::Proposal& proposal) {
  const std::uint64_t number = proposal.candidates().front().version_number();
  const ProposalRecord* same_number = robot.find_proposal(number);
  const std::uint64_t incarnation = proposal.candidates().front().incarnation();
  if (same_number && same_number->candidates.front().incarnation() == incarnation) return;
  ProposalRecord& record = robot.add_proposal();
  record.number = number;
  record.stamp_ns = proposal.header().stamp_ns();
  record.epoch = proposal.epoch();
  record.count = proposal.candidate_count();
  for (std::size_t i = 0; i < record.count; ++i) {
    record.candidates[i] = proposal.candidates()[i];
    // The verdict may have overtaken the proposal.
    const VersionNumber candidate = record.candidates[i].version_number();
    KnownVersion* known = robot.find(candidate);
    const auto is_grant = [&](const EarlyVerdict& v) {
      return v.granted == candidate && v.request_stamp_ns == record.stamp_ns;
    };
    const bool is_same_agents_version =
        run_.is_complete() ||
        (known && known->has_content ? known->version.incarnation() == incarnation
                                     : std::ranges::any_of(robot.early_verdicts, is_grant));
    if (!known || !is_same_agents_version) continue;
    known->is_proposed = true;
    if (known->has_content || known->granted_in == 0) continue;
    if (KnownVersion* stored = robots_.store(robot, record.candidates[i])) {
      content_.check(robot, *stored);
      pairs_.check_new(robot, *stored);
    }
  }
  for (const EarlyVerdict& verdict : robot.early_verdicts) {
    const bool is_answer =
        verdict.proposal == number && (run_.is_complete() || verdict.request_stamp_ns == record.stamp_ns);
    if (is_answer) decide(robot, record, verdict.epoch, verdict.granted);
  }
}

void GrantAudit::on_verdict(AuditedRobot& robot, const msg::Verdict& verdict, const Reception& reception) {
  ProposalRecord* proposal = answered_proposal(robot, verdict);
  if (!proposal && is_final(verdict)) {
    robot.early_verdicts[robot.early_verdict_count++ % robot.early_verdicts.size()] = {
        verdict.proposal_number(), verdict.request_stamp_ns(), verdict.epoch(), verdict.granted_version()};
  } else if (is_final(verdict)) {
    decide(robot, *proposal, verdict.epoch(), verdict.granted_version());
  }
  if (verdict.granted_version() == 0 || !times_.are_comparable(verdict.header())) return;
  const KnownVersion* before = robot.find(verdict.granted_version());
  // A delayed coordinator may repeat its verdict on an old proposal, whose version may have been evicted
  // here.
  if (robot.was_evicted(verdict.granted_version())) return;
  const std::int64_t granted_by_ns = times_.granter_time_ns(verdict.header(), reception);
  if (before && before->granted_in == verdict.epoch()) {
    robot.find(verdict.granted_version())->granted_by_ns = std::min(before->granted_by_ns, granted_by_ns);
    return;
  }
  // Another agent's version may have the same number.
  const msg::Version* candidate = proposal ? proposal->find(verdict.granted_version()) : nullptr;
  const bool is_same_version =
      run_.is_complete() || (candidate && before && before->has_content &&
                             before->version.incarnation() == candidate->incarnation());
  const bool was_granted =
      before && before->granted_in != 0 && !before->is_own_stop && !before->is_granted_by_page;
  if (was_granted && is_same_version) {
    findings_.report(AuditRule::kVersionOrder, robot.id, before, verdict.epoch(),
                     "had already been granted in epoch {}", before->granted_in);
    return;
  }
  const bool was_never_proposed =
      run_.is_complete() && !proposal && verdict.proposal_number() > robot.max_evicted_proposal;
  const bool is_wrong_epoch = candidate && proposal->epoch != verdict.epoch();
  if ((proposal && !candidate) || is_wrong_epoch || was_never_proposed) {
    KnownVersion& known = robot.find_or_insert(verdict.granted_version());
    findings_.report(AuditRule::kProposed, robot.id, &known, verdict.epoch(),
                     is_wrong_epoch
                         ? fmt::format("was proposed in epoch {}", proposal->epoch)
                         : fmt::format("is not a candidate of proposal {}", verdict.proposal_number()));
  }
  KnownVersion* known =
      candidate ? robots_.store(robot, *candidate) : &robot.find_or_insert(verdict.granted_version());
  if (!known) return;
  known->granted_in = verdict.epoch();
  known->granted_by_ns = granted_by_ns;
  known->is_granted_by_page = false;
  if (candidate || verdict.proposal_number() <= robot.max_evicted_proposal) known->is_proposed = true;
  check_grant(robot, *known, verdict);
  check_hold(*known, verdict);
}

// A held robot may be granted a rest version at the place where it will be put down. A verdict may be a
// repetition. So if messages may have been missed, a version is known to have been granted after the hold
// only if it starts long after the hold.
void GrantAudit::check_hold(const KnownVersion& known, const msg::Verdict& verdict) {
  const bool is_place = known.version.base() == 0 && known.path.duration_s() <= 0;
  if (!known.has_content || is_place) return;
  orders_.on_grant(verdict, run_.is_complete() ? kAlways : known.version.start_ns() - kMaxLead_ns);
}

ProposalRecord* GrantAudit::answered_proposal(AuditedRobot& robot, const msg::Verdict& verdict) const {
  const std::uint64_t number = verdict.proposal_number();
  return run_.is_complete() ? robot.find_proposal(number)
                            : robot.find_proposal(number, verdict.request_stamp_ns());
}

void GrantAudit::decide(AuditedRobot& robot, ProposalRecord& proposal, Epoch epoch, VersionNumber granted) {
  if (proposal.epoch != epoch) return;
  proposal.is_decided = true;
  proposal.granted = granted;
  for (std::size_t i = 0; i < proposal.count; ++i)
    check_forwarded(robot, proposal.candidates[i].version_number());
}

void GrantAudit::check_grant(AuditedRobot& robot, KnownVersion& known, const msg::Verdict& verdict) {
  epochs_.on_grant(robot, known, verdict);
  if (run_.is_complete() && robot.newest_granted_in == verdict.epoch() &&
      known.number <= robot.newest_granted) {
    findings_.report(AuditRule::kVersionOrder, robot.id, &known, verdict.epoch(),
                     "is granted after version {}", robot.newest_granted);
  }
  if (verdict.epoch() >= robot.newest_granted_in) {
    robot.newest_granted = verdict.epoch() > robot.newest_granted_in
                               ? known.number
                               : std::max(robot.newest_granted, known.number);
    robot.newest_granted_in = verdict.epoch();
  }
  if (!known.has_content) return;
  content_.check(robot, known);
  pairs_.check_new(robot, known);
}

void GrantAudit::on_command(AuditedRobot& robot, const msg::Command& command, const Reception& reception) {
  KnownVersion* known = robots_.store(robot, command.version());
  if (!known) return;
  known->sent_ns = std::min(known->sent_ns, reception.earliest_ns);
  known->sent_epoch = std::max(known->sent_epoch, command.epoch());
  check_forwarded(robot, known->number);
}

void GrantAudit::check_forwarded(AuditedRobot& robot, VersionNumber number) {
  KnownVersion* known = robot.find(number);
  if (!known || known->sent_ns == kNever || known->is_reported_unsent) return;
  const ProposalRecord* proposal = robot.find_proposal_of(known->version);
  const bool was_denied = proposal && proposal->is_decided && proposal->granted != number;
  const bool was_never_granted =
      run_.is_complete() && known->granted_in == 0 && known->number > robot.max_evicted_version;
  if (!was_denied && !was_never_granted) return;
  known->is_reported_unsent = true;
  findings_.report(AuditRule::kForwarded, robot.id, known, known->sent_epoch,
                   was_denied ? fmt::format("the verdict on proposal {} granted version {}", proposal->number,
                                            proposal->granted)
                              : "no verdict has granted it");
}

}  // namespace sidestep
