// SPDX-License-Identifier: Apache-2.0
// Checks of what the coordinator grants and of the contents of its ledger.
#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "deploy/audit/auditor.hpp"

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

void Auditor::on_verdict(const msg::Verdict& verdict, Time now) {
  now_ = now;
  if (verdict.robot() >= index_.size() || index_[verdict.robot()] == robots_.size()) {
    ++totals_.invalid;
    return;
  }
  AuditedRobot& robot = robots_[index_[verdict.robot()]];
  const Reception reception = trace(kVerdictKind, robot.id, verdict.header());
  if (verdict.proposal_number() == 0) return;
  ProposalRecord* proposal = answered_proposal(robot, verdict);
  if (!proposal && is_final(verdict)) {
    robot.early_verdicts[robot.early_verdict_count++ % robot.early_verdicts.size()] = {
        verdict.proposal_number(), verdict.request_stamp_ns(), verdict.epoch(), verdict.granted_version()};
  } else if (is_final(verdict)) {
    decide(robot, *proposal, verdict.epoch(), verdict.granted_version());
  }
  if (verdict.granted_version() == 0) return;
  begin_run();
  if (!are_times_comparable(verdict.header())) return;
  const KnownVersion* before = robot.find(verdict.granted_version());
  // A delayed coordinator may repeat its verdict on an old proposal, whose version may have been evicted
  // here.
  if (robot.was_evicted(verdict.granted_version())) return;
  const std::int64_t granted_by_ns = granter_time_ns(verdict.header(), reception);
  if (before && before->granted_in == verdict.epoch()) {
    robot.find(verdict.granted_version())->granted_by_ns = std::min(before->granted_by_ns, granted_by_ns);
    return;
  }
  // Another agent's version may have the same number.
  const msg::Version* candidate = proposal ? proposal->find(verdict.granted_version()) : nullptr;
  const bool is_same_version =
      input_.is_complete || (candidate && before && before->has_content &&
                             before->version.incarnation() == candidate->incarnation());
  const bool was_granted =
      before && before->granted_in != 0 && !before->is_own_stop && !before->is_granted_by_page;
  if (was_granted && is_same_version) {
    report(AuditRule::kVersionOrder, robot.id, before, verdict.epoch(),
           fmt::format("had already been granted in epoch {}", before->granted_in));
    return;
  }
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
  known->granted_by_ns = granted_by_ns;
  known->is_granted_by_page = false;
  if (candidate || verdict.proposal_number() <= robot.max_evicted_proposal) known->is_proposed = true;
  check_grant(robot, *known, verdict);
  judge_order(*known, verdict);
}

// A robot that is to be put down is granted its place although it is held. A verdict may be repeated; if not
// all messages are received, only a version that starts long after the hold was certainly granted after it.
void Auditor::judge_order(const KnownVersion& known, const msg::Verdict& verdict) {
  const bool is_place = known.version.base() == 0 && known.path.duration_s() <= 0;
  if (!known.has_content || is_place) return;
  orders_.on_grant(verdict, input_.is_complete ? kAlways : known.version.start_ns() - kMaxLead_ns);
}

ProposalRecord* Auditor::answered_proposal(AuditedRobot& robot, const msg::Verdict& verdict) const {
  const std::uint64_t number = verdict.proposal_number();
  return input_.is_complete ? robot.find_proposal(number)
                            : robot.find_proposal(number, verdict.request_stamp_ns());
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
  const Incarnation incarnation = verdict.header().incarnation();
  if (record.first_grant_ns == kNever) {
    record.granter = verdict.header().sender();
    record.granter_incarnation = incarnation;
    for (const AuditedRobot& other : robots_) {
      if (!input_.is_complete || other.registered_in.may_have_held(verdict.epoch()) ||
          verdict.epoch() <= other.attested_until)
        continue;
      record.is_reported = true;
      report(
          AuditRule::kAllRegistered, other.id, nullptr, verdict.epoch(),
          fmt::format("had not registered when version {} of robot {} was granted", known.number, robot.id));
    }
  } else if (record.granter_incarnation != incarnation || record.granter != verdict.header().sender()) {
    report(AuditRule::kSingleCoordinator, robot.id, &known, verdict.epoch(),
           fmt::format("coordinator {} (incarnation {}) grants after coordinator {} (incarnation {})",
                       verdict.header().sender(), incarnation, record.granter, record.granter_incarnation));
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
      granter == epochs_.end() || granter->second.granter_incarnation == page.header().incarnation();
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
    const bool may_be_forgotten = page.epoch() <= robot.forgotten_in;
    if (input_.is_complete && is_of_epoch && !may_be_held && !may_be_forgotten) {
      report(AuditRule::kLedgerPage, robot.id,
             known ? known : &robot.find_or_insert(version.version_number()), page.epoch(),
             "is in the ledger, but was neither registered nor granted");
    }
    KnownVersion* stored = store(robot, version);
    if (!stored || stored->is_in(page.epoch()) || stored->granted_in != 0) continue;
    // A version that was proposed in this epoch was not registered, so its verdict was missed.
    const ProposalRecord* proposal = robot.find_proposal_of(stored->version);
    const bool was_granted = !input_.is_complete && proposal && proposal->epoch == page.epoch();
    if (!stored->is_own_stop && !was_granted) continue;
    if (proposal) stored->is_proposed = true;
    stored->granted_in = page.epoch();
    stored->granted_by_ns = granter_time_ns(page.header(), reception);
    stored->is_granted_by_page = true;
    if (!stored->is_own_stop) {
      check_content(robot, *stored);
      check_new_pairs(robot, *stored);
    }
  }
  if (!input_.is_complete)
    use_ledger_page(page);
  else if (is_of_epoch)
    check_ledger_page(page);
}

// The ledger never takes back a version that it has forgotten, so it held one from the first page that listed
// it to the last. All versions of a robot are on one page.
void Auditor::use_ledger_page(const msg::LedgerPage& page) {
  if (!are_times_comparable(page.header())) return;
  EpochRecord& record = epoch_record(page.epoch());
  if (record.page_incarnation == 0) record.page_incarnation = page.header().incarnation();
  const bool is_of_granter =
      record.first_grant_ns == kNever || record.granter_incarnation == page.header().incarnation();
  if (record.page_incarnation != page.header().incarnation() || !is_of_granter) return;
  const auto& versions = page.versions();
  const std::int64_t at_ns = page.header().stamp_ns();
  std::size_t begin = 0;
  while (begin < versions.size()) {
    const auto index = roster_index(versions[begin].robot());
    std::size_t end = begin + 1;
    while (end < versions.size() && versions[end].robot() == versions[begin].robot()) ++end;
    const std::size_t first = std::exchange(begin, end);
    if (!index) continue;
    AuditedRobot& robot = robots_[*index];
    earlier_evidence_.clear();
    for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i)
      earlier_evidence_.push_back(evidence_of(robot.versions[i]));
    const bool is_next_page = robot.listed.epoch == page.epoch() && robot.listed.at_ns < at_ns;
    for (std::size_t i = first; i < end; ++i) {
      KnownVersion* known = robot.find(versions[i].version_number());
      if (!known || !(known->version == versions[i]) || known->listed_in > page.epoch()) continue;
      if (known->listed_in < page.epoch()) {
        known->listed_in = page.epoch();
        known->listed_from_ns = at_ns;
        known->alive_until_ns = at_ns;
        const bool was_unlisted = is_next_page && known->number > robot.max_evicted_version;
        known->entered_after_ns = was_unlisted ? robot.listed.at_ns : kAlways;
      }
      known->listed_from_ns = std::min(known->listed_from_ns, at_ns);
      known->alive_until_ns = std::max(known->alive_until_ns, at_ns);
      if (known->granted_in == page.epoch() && known->alive_until_ns >= known->granted_by_ns)
        known->is_pair_checked = true;
    }
    if (is_next_page || robot.listed.epoch < page.epoch()) robot.listed = {page.epoch(), at_ns};
    check_pairs(robot, earlier_evidence_);
  }
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
      // The ledger still describes the robot on its former floor.
      if (known.number == 0 && page.epoch() <= robot.forgotten_in) continue;
      if (std::ranges::find(page_numbers_, known.number) != page_numbers_.end()) continue;
      report(AuditRule::kLedgerPage, id, &known, page.epoch(),
             "is not in the ledger, although no fact has excluded it");
    }
  }
}

}  // namespace sidestep
