// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>

#include "common/messaging/bus.hpp"
#include "deploy/audit/grant_audit.hpp"
#include "deploy/audit/ledger_audit.hpp"
#include "deploy/audit/reference_audit.hpp"
#include "deploy/audit/robot_report_audit.hpp"

namespace sidestep {

/// Checks all messages of a run against the rules of the safety protocol and reports each violation with the
/// robots and versions involved. It checks the form and the sender of each message, and passes the message on
/// to the audits that it concerns. Shares no code with the components under audit. The auditor may join late,
/// miss messages and receive them late and out of order. It then relies only on contradictions between
/// received messages that no missing message could resolve. It may then overlook violations, but never raises
/// a false alarm, and its totals state how much it covered. If messages may be missed, it knows the order of
/// two messages only if they have the same sender or if one refers to the other. Operators' messages must not
/// be lost. Memory is bounded by the roster.
class Auditor {
 public:
  Auditor(const Scenario& scenario, const AuditInput& input);
  Auditor(const Auditor&) = delete;
  Auditor& operator=(const Auditor&) = delete;

  void on_proposal(const msg::Proposal& proposal, Time now);
  void on_verdict(const msg::Verdict& verdict, Time now);
  void on_registration(const msg::Registration& registration, Time now);
  void on_coordinator(const msg::CoordinatorState& state, Time now);
  void on_ledger(const msg::LedgerPage& page, Time now);
  void on_command(const msg::Command& command, Time now);
  void on_robot_report(const msg::Feedback& feedback, Time now);
  /// Ground truth is the reference for positions and contacts, and shows which robots were disturbed.
  void on_truth(const msg::GroundTruth& truth, Time now);
  /// The world state is the reference if no ground truth is received.
  void on_world_state(const msg::WorldState& world, Time now);
  /// Names the cause of a disturbance. Without ground truth, it also proves the disturbance.
  void on_disturbance(const msg::Disturbance& disturbance, Time now);
  /// Processes an operator's attestation that a silent robot is not on the floor.
  void on_attestation(const msg::AbsenceAttestation& attestation, Time now);
  void on_order(const msg::Order& order, Time now);
  void on_order_answer(const msg::OrderAnswer& answer, Time now);
  /// Processes the order memory of a coordinator or an agent.
  void on_order_memory(const msg::OrderMemory& memory, Time now);
  void on_order_status(const msg::OrderStatus& status, Time now);
  /// Counts a message that was refused because its sender has different rules.
  void on_refused() { ++findings_.totals.refused; }
  /// Advances the time, also when there are no messages.
  void advance(Time now) { findings_.now = std::max(findings_.now, now); }

  AuditTotals totals() const;
  /// Calls back for each violation as it is found.
  void on_violation(std::function<void(const Violation&)> callback) {
    findings_.on_violation = std::move(callback);
  }

 private:
  using Kind = MessageTimes::Kind;

  /// Returns the robot. If it is not on the roster, counts the message as invalid and returns nullptr.
  AuditedRobot* known_robot(RobotId robot);
  /// Returns the robot. If it did not send the message, counts the message as invalid and returns nullptr.
  AuditedRobot* sender_of(RobotId robot, const msg::Header& header);
  Reception trace(Kind kind, std::uint32_t key, const msg::Header& header);

  const AuditedRun run_;
  AuditFindings findings_;
  MessageTimes times_;
  RobotRecords robots_;
  RunCoverage coverage_;
  ContentAudit content_;
  PairAudit pairs_;
  EpochAudit epochs_;
  OrderAudit orders_;
  GrantAudit grants_;
  LedgerAudit ledger_;
  RobotReportAudit facts_;
  ReferenceAudit reference_;
};

/// Subscribes the auditor to a bus. The auditor must outlive the bus's last callback.
void listen(Bus& bus, const Scenario& scenario, Auditor& auditor);
/// Makes a bus that only the auditor uses refuse messages from processes with different rules (PROTOCOL.md,
/// "The same rules"); the auditor counts them. In processes with other buses RulesExchange does this.
void refuse_other_rules(Bus& bus, const Scenario& scenario, Auditor& auditor);

}  // namespace sidestep
