// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/ledger_audit.hpp"

#include <algorithm>

namespace sidestep {

void LedgerAudit::on_page(const msg::LedgerPage& page, const Reception& reception) {
  for (const msg::Version& version : page.versions()) {
    if (AuditedRobot* robot = robots_.find(version.robot()))
      check_entry(*robot, version, page, reception);
    else
      ++findings_.totals.invalid;
  }
  const bool is_usable = run_.is_complete()
                             ? epochs_.is_from_granter(page)
                             : times_.are_comparable(page.header()) && epochs_.is_from_first_sender(page);
  if (!is_usable) return;
  // All versions of a robot are on one page.
  const Versions all = page.versions();
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].robot() == all[begin].robot()) ++end;
    AuditedRobot* robot = robots_.find(all[begin].robot());
    if (!robot) continue;
    const Versions versions = all.subspan(begin, end - begin);
    if (run_.is_complete())
      check_complete(*robot, versions, page.epoch());
    else
      learn(*robot, versions, page);
  }
}

void LedgerAudit::check_entry(AuditedRobot& robot, const msg::Version& version, const msg::LedgerPage& page,
                              const Reception& reception) {
  const KnownVersion* known = robot.find(version.version_number());
  // A coordinator that receives no reports keeps versions that the auditor evicted long ago.
  const bool was_evicted = robot.was_evicted(version.version_number());
  if (was_evicted && !known) return;
  const bool stays_admissible =
      was_evicted || (known && (known->may_be_in(page.epoch()) || known->is_own_stop));
  const bool may_be_forgotten = page.epoch() <= robot.forgotten_until_epoch;
  if (run_.is_complete() && epochs_.is_from_granter(page) && !stays_admissible && !may_be_forgotten) {
    findings_.report(AuditRule::kLedgerPage, robot.id,
                     known ? known : &robot.find_or_insert(version.version_number()), page.epoch(),
                     "is in the ledger, but was neither registered nor granted");
  }
  KnownVersion* stored = robots_.store(robot, version);
  if (!stored || stored->is_in(page.epoch()) || stored->granted_in != 0) return;
  // A version that was proposed in this epoch was not registered, so it was granted by a verdict that was
  // missed.
  const ProposalRecord* proposal = robot.find_proposal_of(stored->version);
  const bool was_granted = !run_.is_complete() && proposal && proposal->epoch == page.epoch();
  if (!stored->is_own_stop && !was_granted) return;
  if (proposal) stored->is_proposed = true;
  stored->granted_in = page.epoch();
  stored->granted_by_ns = times_.granter_time_ns(page.header(), reception);
  stored->is_granted_by_page = true;
  if (!stored->is_own_stop) {
    content_.check(robot, *stored);
    pairs_.check_new(robot, *stored);
  }
}

// A version that the ledger has forgotten never returns, so the ledger contained a version from the first
// page that listed it until the last one.
void LedgerAudit::learn(AuditedRobot& robot, Versions versions, const msg::LedgerPage& page) {
  const std::int64_t at_ns = page.header().stamp_ns();
  pairs_.remember_evidence(robot);
  const bool is_next_page = robot.listed.epoch == page.epoch() && robot.listed.at_ns < at_ns;
  for (const msg::Version& version : versions) {
    KnownVersion* known = robot.find(version.version_number());
    if (!known || !(known->version == version) || known->listed_in > page.epoch()) continue;
    if (known->listed_in < page.epoch()) {
      known->listed_in = page.epoch();
      known->listed_from_ns = at_ns;
      known->in_ledger_until_ns = at_ns;
      const bool was_unlisted = is_next_page && known->number > robot.max_evicted_version;
      known->entered_after_ns = was_unlisted ? robot.listed.at_ns : kAlways;
    }
    known->listed_from_ns = std::min(known->listed_from_ns, at_ns);
    known->in_ledger_until_ns = std::max(known->in_ledger_until_ns, at_ns);
    if (known->granted_in == page.epoch() && known->in_ledger_until_ns >= known->granted_by_ns)
      known->is_pair_checked = true;
  }
  if (is_next_page || robot.listed.epoch < page.epoch()) robot.listed = {page.epoch(), at_ns};
  pairs_.check_changes(robot);
}

void LedgerAudit::check_complete(const AuditedRobot& robot, Versions versions, Epoch epoch) {
  for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i) {
    const KnownVersion& known = robot.versions[i];
    // The version's content may have been evicted here before a delayed coordinator granted the version.
    if (!known.has_content) continue;
    if (known.exclusion != Exclusion::kNone || known.is_own_stop || !known.is_in(epoch)) continue;
    // The ledger still describes the robot on its former floor.
    if (known.number == 0 && epoch <= robot.forgotten_until_epoch) continue;
    if (std::ranges::any_of(versions, [&](const auto& v) { return v.version_number() == known.number; }))
      continue;
    findings_.report(AuditRule::kLedgerPage, robot.id, &known, epoch,
                     "is not in the ledger, although no report of its robot has excluded it");
  }
}

}  // namespace sidestep
