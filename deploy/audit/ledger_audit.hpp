// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "deploy/audit/content_audit.hpp"
#include "deploy/audit/epoch_audit.hpp"
#include "deploy/audit/pair_audit.hpp"

namespace sidestep {

/// Checks the pages of the ledger, and learns from them what was granted and which versions the ledger held
/// at the same time.
class LedgerAudit {
 public:
  LedgerAudit(const AuditedRun& run, const MessageTimes& times, RobotRecords& robots, EpochAudit& epochs,
              ContentAudit& content, PairAudit& pairs, AuditFindings& findings)
      : run_(run),
        times_(times),
        robots_(robots),
        epochs_(epochs),
        content_(content),
        pairs_(pairs),
        findings_(findings) {}

  void on_page(const msg::LedgerPage& page, const Reception& reception);

 private:
  using Versions = std::span<const msg::Version>;  ///< the versions of one robot on a page

  void check_entry(AuditedRobot& robot, const msg::Version& version, const msg::LedgerPage& page,
                   const Reception& reception);
  /// Learns which versions of the robot the ledger contained at the time of the page.
  void learn(AuditedRobot& robot, Versions versions, const msg::LedgerPage& page);
  void check_complete(const AuditedRobot& robot, Versions versions, Epoch epoch);

  const AuditedRun& run_;
  const MessageTimes& times_;
  RobotRecords& robots_;
  EpochAudit& epochs_;
  ContentAudit& content_;
  PairAudit& pairs_;
  AuditFindings& findings_;
};

}  // namespace sidestep
