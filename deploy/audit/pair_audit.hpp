// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "deploy/audit/robot_records.hpp"

namespace sidestep {

/// Checks the clearance between versions of two robots that a ledger held, or that the robots executed, at
/// the same time.
class PairAudit {
 public:
  PairAudit(const AuditedRun& run, const RobotRecords& robots, AuditFindings& findings);

  /// Remembers the present evidence about the robot's recent versions.
  void remember_evidence(const AuditedRobot& robot);
  /// Checks the pairs for which evidence newer than remember_evidence() proves that they were held or
  /// executed at the same time. Precondition: the last call of remember_evidence() was for this robot.
  void check_changes(const AuditedRobot& robot);
  /// Checks a newly granted version against all others.
  void check_new(const AuditedRobot& robot, KnownVersion& known);

 private:
  /// The evidence about a version before the current message.
  struct Evidence {
    explicit Evidence(const KnownVersion& known)
        : in_ledger_until_ns(known.in_ledger_until_ns),
          executed_until_ns(known.executed_until_ns),
          was_executed(known.was_executed) {}
    bool operator==(const Evidence&) const = default;

    std::int64_t in_ledger_until_ns, executed_until_ns;
    bool was_executed;
  };

  /// Checks the changed versions against the live ones of another robot.
  void check_changes(const AuditedRobot& robot, std::size_t other);
  /// The epoch whose ledger provably contained both versions at the same time. 0 if both were provably
  /// executed at the same time. nullopt if neither is proven.
  std::optional<Epoch> common_epoch(const KnownVersion& a, const Evidence& a_evidence, const KnownVersion& b,
                                    const Evidence& b_evidence) const;
  /// Whether `granted` was checked against `other` when it was granted, assuming that the ledger contained
  /// both at the same time.
  bool was_checked_against(const KnownVersion& granted, const KnownVersion& other) const;
  /// Whether the two robots' times can be compared.
  bool are_clocks_comparable(const AuditedRobot& a, const AuditedRobot& b) const;
  void check_pair(const AuditedRobot& ra, const KnownVersion& a, const AuditedRobot& rb,
                  const KnownVersion& b, Epoch epoch);
  /// Whether `later` is excused because its base was already too close; nullopt if its base was not received.
  std::optional<bool> is_excused(const AuditedRobot& robot, const KnownVersion& later,
                                 const KnownVersion& other, double distance_m) const;
  /// A cheap necessary condition for a conflict: the new evidence for `mine` can complete the proof that both
  /// were held at the same time, and the two versions are close enough to conflict.
  bool may_conflict(const LiveVersion& mine, const Evidence& before, const LiveVersion& theirs) const;
  double min_separation_m(const KnownVersion& a, const KnownVersion& b) const;

  const AuditedRun& run_;
  const RobotRecords& robots_;
  AuditFindings& findings_;
  const std::int64_t clock_bound_ns_;
  std::vector<BoundingDisc> bounds_;                     ///< parallel to the robots
  std::vector<std::vector<LiveVersion>> live_versions_;  ///< parallel to the robots
  std::vector<Evidence> before_;  ///< evidence before the current message, for the robot's recent versions
  std::vector<LiveVersion> changed_;
};

}  // namespace sidestep
