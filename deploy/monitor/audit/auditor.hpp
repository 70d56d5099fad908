// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "deploy/monitor/audit/audit_rules.hpp"
#include "deploy/monitor/audit/audited_robot.hpp"
#include "deploy/monitor/audit/disturbances.hpp"
#include "deploy/monitor/audit/message_trace.hpp"

namespace sidestep {

/// Which messages the auditor receives, and how soon.
struct AuditInput {
  /// It receives every message from the start on, at the moment it is sent. Only then is a missing message
  /// evidence.
  bool is_complete = false;
  /// Upper bound of the minimum latency from any sender to the auditor. Unused if is_complete.
  Duration min_latency_bound{5'000'000};
};

/// Checks all messages of a run against the rules of the safety protocol and reports each violation with the
/// robots and versions involved. Shares no code with the components under audit. The auditor may join late,
/// miss messages and receive them out of order. It then relies only on contradictions between received
/// messages: it finds less, but never raises a false alarm. Memory is bounded by the roster.
class Auditor {
 public:
  Auditor(const Scenario& scenario, const AuditInput& input);

  void on_proposal(const msg::Proposal& proposal, Time now);
  void on_verdict(const msg::Verdict& verdict, Time now);
  void on_registration(const msg::Registration& registration, Time now);
  void on_coordinator(const msg::CoordinatorState& state, Time now);
  void on_ledger(const msg::LedgerPage& page, Time now);
  void on_command(const msg::Command& command, Time now);
  void on_feedback(const msg::Feedback& feedback, Time now);
  /// Contacts and position errors of a robot are excused from an operator's disturbance until the robot is
  /// observed on its reference again.
  void on_truth(const msg::GroundTruth& truth, Time now);

  AuditTotals totals() const;
  /// Calls back for each violation when it is found.
  void on_violation(std::function<void(const Violation&)> callback) { on_violation_ = std::move(callback); }

 private:
  /// What is known about one epoch.
  struct EpochRecord {
    std::uint32_t granter = 0;
    Incarnation granter_life = 0;
    std::int64_t first_grant_ns = kNever;  ///< upper bound
    bool is_reported = false;
  };
  /// What had been proven about a version before the current message.
  struct Evidence {
    std::int64_t alive_until_ns, executed_until_ns;
    bool was_executed;
    bool operator==(const Evidence&) const = default;
  };
  /// The latest ground truth of one robot that has not been compared with feedback yet.
  struct Observation {
    std::int64_t at_ns = kNever;
    double x = 0, y = 0;
  };

  void report(AuditRule rule, RobotId robot, const KnownVersion* known, Epoch epoch, std::string detail);
  void report(Violation violation);
  AuditedRobot* robot_of(std::uint32_t robot, const msg::Header& header);
  std::size_t index_of(const AuditedRobot& robot) const {
    return static_cast<std::size_t>(&robot - robots_.data());
  }
  /// Topics whose messages a sender numbers separately.
  enum Kind : std::uint8_t {
    kProposalKind,
    kVerdictKind,
    kRegistrationKind,
    kCoordinatorKind,
    kLedgerKind,
    kCommandKind,
    kFeedbackKind,
    kTruthKind
  };
  Reception trace(Kind kind, std::uint32_t key, const msg::Header& header);
  /// Stores the version's content and returns its record; nullptr if the content is invalid.
  KnownVersion* store(AuditedRobot& robot, const msg::Version& version);
  EpochRecord& epoch_record(Epoch epoch);

  // Grants.
  void decide(AuditedRobot& robot, ProposalRecord& proposal, Epoch epoch, VersionNumber granted);
  void check_grant(AuditedRobot& robot, KnownVersion& known, const msg::Verdict& verdict);
  void check_content(const AuditedRobot& robot, const KnownVersion& known);
  void check_limits(const AuditedRobot& robot, const KnownVersion& known);
  void check_field(const AuditedRobot& robot, const KnownVersion& known);
  void check_obstacles(const AuditedRobot& robot, const KnownVersion& known);
  void check_base(const AuditedRobot& robot, const KnownVersion& known);
  void check_granting_epoch(const AuditedRobot& robot, const KnownVersion& known,
                            const msg::Verdict& verdict);
  void check_forwarded(AuditedRobot& robot, VersionNumber number);
  void check_ledger_page(const msg::LedgerPage& page);

  // Facts.
  void check_fact_order(const AuditedRobot& robot, const msg::Feedback& feedback);
  void check_switch(const AuditedRobot& robot, const KnownVersion& to, const msg::Feedback& feedback);
  void check_sent(AuditedRobot& robot, KnownVersion& executing);
  void check_tracking(AuditedRobot& robot, const KnownVersion& executing, const msg::Feedback& feedback,
                      const Reception& reception);
  void check_own_stop(const AuditedRobot& robot, const KnownVersion& own_stop);
  void check_obeyed_epochs(AuditedRobot& robot, const KnownVersion& executing, const msg::Feedback& feedback,
                           const Reception& reception);
  void check_position(AuditedRobot& robot, const msg::Feedback& feedback, const Reception& reception);
  /// `reported`: number of contacts in the previous ground truth.
  void check_contacts(const msg::GroundTruth& truth, std::uint64_t reported);
  void record_positions(const msg::GroundTruth& truth);
  /// nullopt: not on the roster.
  std::optional<std::size_t> roster_index(RobotId robot) const;
  static void exclude(AuditedRobot& robot, const AuditedRobot::Fact& fact, const Reception& reception,
                      std::int64_t now_ns);
  bool is_clock_sound(const msg::Feedback& feedback, const Reception& reception) const;

  // Pairs.
  /// `before`: the evidence for the robot's recent versions before the current fact.
  void check_pairs(const AuditedRobot& robot, const std::vector<Evidence>& before);
  void check_new_pairs(AuditedRobot& robot, const KnownVersion& known);
  /// The epoch whose ledger provably held both versions at one time; 0 if both were provably executed at one
  /// time; nullopt if neither is proven.
  std::optional<Epoch> common_epoch(const KnownVersion& a, const Evidence& a_evidence, const KnownVersion& b,
                                    const Evidence& b_evidence) const;
  void check_pair(const AuditedRobot& ra, const KnownVersion& a, const AuditedRobot& rb,
                  const KnownVersion& b, Epoch epoch);
  /// nullopt: the version's base was not received.
  std::optional<bool> is_excused(const AuditedRobot& robot, const KnownVersion& later,
                                 const KnownVersion& other, double distance_m) const;
  /// Cheap necessary condition: the new evidence for `mine` can complete the proof that both were held at one
  /// time, and the two are close enough to conflict.
  bool may_conflict(const LiveVersion& mine, const Evidence& before, const LiveVersion& theirs) const;
  double min_separation_m(const KnownVersion& a, const KnownVersion& b) const;
  static Evidence evidence_of(const KnownVersion& known);

  Scenario scenario_;
  AuditInput input_;
  double tracking_bound_m_;
  std::int64_t clock_bound_ns_;
  MessageTrace trace_;
  Time now_{};
  std::vector<AuditedRobot> robots_;                     ///< ascending by id
  std::vector<BoundingDisc> bounds_;                     ///< parallel to robots_
  std::vector<std::vector<LiveVersion>> live_versions_;  ///< parallel to robots_
  double max_inflation_m_ = 0;                           ///< of all versions received so far
  std::vector<bool> has_sound_clock_;
  std::vector<Observation> observations_;
  std::vector<std::optional<Vec2>> positions_m_;  ///< in the latest ground truth, parallel to robots_
  Disturbances disturbances_;
  std::vector<std::size_t> index_;  ///< by id; robots_.size(): not on the roster
  std::map<Epoch, EpochRecord> epochs_;
  struct AgentStream {
    Incarnation incarnation = 0;
    Epoch epoch = 0;
  };
  std::map<std::uint32_t, std::vector<AgentStream>> agent_epochs_;
  std::map<std::uint64_t, msg::GroundTruth> truths_;  ///< the latest counters of each simulator incarnation
  std::vector<Evidence> earlier_evidence_;
  std::vector<LiveVersion> changed_;
  std::vector<VersionNumber> page_numbers_;
  AuditTotals totals_;
  std::function<void(const Violation&)> on_violation_;
};

/// Subscribes the auditor to a bus; the auditor must outlive the bus's last callback.
void listen(Bus& bus, const Scenario& scenario, Auditor& auditor);

}  // namespace sidestep
