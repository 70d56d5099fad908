// SPDX-License-Identifier: Apache-2.0
// Checks of what the coordinator grants and of the contents of its ledger.
#include <algorithm>
#include <fmt/format.h>

#include "deploy/monitor/audit/auditor.hpp"

namespace sidestep {
namespace {

/// Whether the candidates that a verdict does not grant are denied for good.
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

void Auditor::on_verdict(const msg::Verdict& verdict, Time now) {
  now_ = now;
  if (verdict.robot() >= index_.size() || index_[verdict.robot()] == robots_.size()) {
    ++totals_.invalid;
    return;
  }
  AuditedRobot& robot = robots_[index_[verdict.robot()]];
  const Reception reception = trace(kVerdictKind, robot.id, verdict.header());
  if (verdict.proposal_number() == 0) return;
  ProposalRecord* proposal = robot.find_proposal(verdict.proposal_number());
  if (!proposal && is_final(verdict)) {
    robot.early_verdicts[robot.early_verdict_count++ % robot.early_verdicts.size()] = {
        verdict.proposal_number(), verdict.epoch(), verdict.granted_version()};
  } else if (is_final(verdict)) {
    decide(robot, *proposal, verdict.epoch(), verdict.granted_version());
  }
  if (verdict.granted_version() == 0) return;
  begin_run();
  const KnownVersion* before = robot.find(verdict.granted_version());
  // A delayed coordinator may repeat its verdict on an old proposal, whose version may have been evicted
  // here.
  if (robot.was_evicted(verdict.granted_version())) return;
  if (before && before->granted_in == verdict.epoch()) {
    robot.find(verdict.granted_version())->granted_by_ns =
        std::min(before->granted_by_ns, reception.latest_ns);
    return;
  }
  if (before && before->granted_in != 0 && !before->is_own_stop && !before->is_granted_by_page) {
    report(AuditRule::kVersionOrder, robot.id, before, verdict.epoch(),
           fmt::format("had already been granted in epoch {}", before->granted_in));
    return;
  }
  const msg::Version* candidate = proposal ? proposal->find(verdict.granted_version()) : nullptr;
  const bool was_never_proposed =
      input_.is_complete && !proposal && verdict.proposal_number() > robot.max_evicted_proposal;
  const bool is_wrong_epoch = candidate && proposal->epoch != verdict.epoch();
  if ((proposal && !candidate) || is_wrong_epoch || was_never_proposed) {
    KnownVersion& known = robot.find_or_insert(verdict.granted_version());
    report(AuditRule::kProposed, robot.id, &known, verdict.epoch(),
           is_wrong_epoch ? fmt::format("was proposed in epoch {}", proposal->epoch)
                          : fmt::format("is not a candidate of proposal {}", verdict.proposal_number()));
  }
  KnownVersion* known =
      candidate ? store(robot, *candidate) : &robot.find_or_insert(verdict.granted_version());
  if (!known) return;
  known->granted_in = verdict.epoch();
  known->granted_by_ns = reception.latest_ns;
  known->is_granted_by_page = false;
  if (candidate || verdict.proposal_number() <= robot.max_evicted_proposal) known->is_proposed = true;
  check_grant(robot, *known, verdict);
}

void Auditor::decide(AuditedRobot& robot, ProposalRecord& proposal, Epoch epoch, VersionNumber granted) {
  if (proposal.epoch != epoch) return;
  proposal.is_decided = true;
  proposal.granted = granted;
  for (std::size_t i = 0; i < proposal.count; ++i)
    check_forwarded(robot, proposal.candidates[i].version_number());
}

void Auditor::check_grant(AuditedRobot& robot, KnownVersion& known, const msg::Verdict& verdict) {
  check_granting_epoch(robot, known, verdict);
  if (input_.is_complete && robot.newest_granted_in == verdict.epoch() &&
      known.number <= robot.newest_granted) {
    report(AuditRule::kVersionOrder, robot.id, &known, verdict.epoch(),
           fmt::format("is granted after version {}", robot.newest_granted));
  }
  if (verdict.epoch() >= robot.newest_granted_in) {
    robot.newest_granted = verdict.epoch() > robot.newest_granted_in
                               ? known.number
                               : std::max(robot.newest_granted, known.number);
    robot.newest_granted_in = verdict.epoch();
  }
  if (!known.has_content) return;
  check_content(robot, known);
  check_new_pairs(robot, known);
}

void Auditor::check_granting_epoch(const AuditedRobot& robot, const KnownVersion& known,
                                   const msg::Verdict& verdict) {
  EpochRecord& record = epoch_record(verdict.epoch());
  const Incarnation life = verdict.header().incarnation();
  if (record.first_grant_ns == kNever) {
    record.granter = verdict.header().sender();
    record.granter_life = life;
    for (const AuditedRobot& other : robots_) {
      if (!input_.is_complete || other.registered_in.may_have_held(verdict.epoch()) ||
          verdict.epoch() <= other.attested_until)
        continue;
      record.is_reported = true;
      report(
          AuditRule::kAllRegistered, other.id, nullptr, verdict.epoch(),
          fmt::format("had not registered when version {} of robot {} was granted", known.number, robot.id));
    }
  } else if (record.granter_life != life || record.granter != verdict.header().sender()) {
    report(AuditRule::kSingleCoordinator, robot.id, &known, verdict.epoch(),
           fmt::format("coordinator {} (incarnation {}) grants after coordinator {} (incarnation {})",
                       verdict.header().sender(), life, record.granter, record.granter_life));
  }
  record.first_grant_ns = std::min(record.first_grant_ns, known.granted_by_ns);
}

void Auditor::on_ledger(const msg::LedgerPage& page, Time now) {
  now_ = now;
  const Reception reception = trace(kLedgerKind, 0, page.header());
  if (page.versions().size() > 256 || page.epoch() == 0) {
    ++totals_.invalid;
    return;
  }
  begin_run();
  const auto granter = epochs_.find(page.epoch());
  const bool is_of_epoch =
      granter == epochs_.end() || granter->second.granter_life == page.header().incarnation();
  for (const msg::Version& version : page.versions()) {
    if (version.robot() >= index_.size() || index_[version.robot()] == robots_.size()) {
      ++totals_.invalid;
      continue;
    }
    AuditedRobot& robot = robots_[index_[version.robot()]];
    const KnownVersion* known = robot.find(version.version_number());
    // A coordinator that receives no facts keeps versions that were evicted here long ago.
    if (robot.was_evicted(version.version_number())) continue;
    const bool may_be_held = known && (known->may_be_in(page.epoch()) || known->is_own_stop);
    if (input_.is_complete && is_of_epoch && !may_be_held) {
      report(AuditRule::kLedgerPage, robot.id,
             known ? known : &robot.find_or_insert(version.version_number()), page.epoch(),
             "is in the ledger, but was neither registered nor granted");
    }
    KnownVersion* stored = store(robot, version);
    if (!stored || stored->is_in(page.epoch()) || stored->granted_in != 0) continue;
    // A version that an agent proposed or sent is not the robot's own stop, so its verdict was missed.
    const bool was_proposed = robot.find_proposal_of(stored->version) != nullptr;
    const bool was_granted = !input_.is_complete && (stored->sent_ns != kNever || was_proposed);
    if (!stored->is_own_stop && !was_granted) continue;
    if (was_proposed) stored->is_proposed = true;
    stored->granted_in = page.epoch();
    stored->granted_by_ns = reception.latest_ns;
    stored->is_granted_by_page = true;
    if (!stored->is_own_stop) {
      check_content(robot, *stored);
      check_new_pairs(robot, *stored);
    }
  }
  if (is_of_epoch && input_.is_complete) check_ledger_page(page);
}

void Auditor::check_ledger_page(const msg::LedgerPage& page) {
  const auto& versions = page.versions();
  std::size_t begin = 0;
  while (begin < versions.size()) {
    std::size_t end = begin;
    page_numbers_.clear();
    for (; end < versions.size() && versions[end].robot() == versions[begin].robot(); ++end)
      page_numbers_.push_back(versions[end].version_number());
    const std::uint32_t id = versions[begin].robot();
    begin = end;
    if (id >= index_.size() || index_[id] == robots_.size()) continue;
    const AuditedRobot& robot = robots_[index_[id]];
    for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
      const KnownVersion& known = robot.versions[i];
      // The version's content may have been evicted here before a delayed coordinator granted the version.
      if (!known.has_content) continue;
      if (known.exclusion != Exclusion::kNone || known.is_own_stop || !known.is_in(page.epoch())) continue;
      if (std::ranges::find(page_numbers_, known.number) != page_numbers_.end()) continue;
      report(AuditRule::kLedgerPage, id, &known, page.epoch(),
             "is not in the ledger, although no fact has excluded it");
    }
  }
}

}  // namespace sidestep
