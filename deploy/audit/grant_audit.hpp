// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/audit/content_audit.hpp"
#include "deploy/audit/epoch_audit.hpp"
#include "deploy/audit/order_audit.hpp"
#include "deploy/audit/pair_audit.hpp"

namespace sidestep {

/// Checks grants: a coordinator grants only what was proposed, and agents forward only what was granted.
/// Passes each grant on to the audits of epochs, contents, pairs and orders.
class GrantAudit {
 public:
  GrantAudit(const AuditedRun& run, const MessageTimes& times, RobotRecords& robots, EpochAudit& epochs,
             ContentAudit& content, PairAudit& pairs, OrderAudit& orders, AuditFindings& findings)
      : run_(run),
        times_(times),
        robots_(robots),
        epochs_(epochs),
        content_(content),
        pairs_(pairs),
        orders_(orders),
        findings_(findings) {}

  void on_proposal(AuditedRobot& robot, const msg::Proposal& proposal);
  /// Checks a verdict. Precondition: it answers a proposal.
  void on_verdict(AuditedRobot& robot, const msg::Verdict& verdict, const Reception& reception);
  /// Checks a command. Precondition: it contains a version.
  void on_command(AuditedRobot& robot, const msg::Command& command, const Reception& reception);

 private:
  void decide(AuditedRobot& robot, ProposalRecord& proposal, Epoch epoch, VersionNumber granted);
  void check_grant(AuditedRobot& robot, KnownVersion& known, const msg::Verdict& verdict);
  /// Passes a grant on to the audit of orders if it lets a robot move.
  void check_hold(const KnownVersion& known, const msg::Verdict& verdict);
  void check_forwarded(AuditedRobot& robot, VersionNumber number);
  /// The proposal that a verdict answers; nullptr if it was not received.
  ProposalRecord* answered_proposal(AuditedRobot& robot, const msg::Verdict& verdict) const;

  const AuditedRun& run_;
  const MessageTimes& times_;
  RobotRecords& robots_;
  EpochAudit& epochs_;
  ContentAudit& content_;
  PairAudit& pairs_;
  OrderAudit& orders_;
  AuditFindings& findings_;
};

}  // namespace sidestep
