// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deploy/audit/content_audit.hpp"
#include "deploy/audit/epoch_audit.hpp"
#include "deploy/audit/motion_audit.hpp"
#include "deploy/audit/pair_audit.hpp"

namespace sidestep {

/// Checks what robots report: the order of their reports, and the versions that they execute.
class RobotReportAudit {
 public:
  RobotReportAudit(const AuditedRun& run, RobotRecords& robots, EpochAudit& epochs, ContentAudit& content,
                   PairAudit& pairs, AuditFindings& findings)
      : run_(run),
        robots_(robots),
        epochs_(epochs),
        content_(content),
        pairs_(pairs),
        findings_(findings),
        motion_(run, findings) {}

  /// Checks a report against what is known about the robot; nullopt if the report must not be used further.
  [[nodiscard]] std::optional<AuditedRobot::ReceivedReport> check(AuditedRobot& robot,
                                                                  const msg::Feedback& feedback,
                                                                  const Reception& reception);
  /// Stores the report that check() has just returned as the robot's latest one. Checks the clearance of the
  /// pairs of versions that the report proves to have been held or executed at the same time.
  void keep(AuditedRobot& robot, const AuditedRobot::ReceivedReport& robot_report);

 private:
  using ReceivedReport = AuditedRobot::ReceivedReport;

  /// If the incarnation is new, forgets what is no longer valid. Returns whether the report counts.
  [[nodiscard]] bool accept_incarnation(AuditedRobot& robot, std::uint64_t incarnation);
  ReceivedReport report_of(const AuditedRobot& robot, const msg::Feedback& feedback,
                           const Reception& reception) const;
  bool is_clock_sound(const msg::Feedback& feedback, const Reception& reception) const;
  void check_order(const AuditedRobot& robot, const ReceivedReport& robot_report, std::int64_t start_ns,
                   bool is_next);
  void check_executing(AuditedRobot& robot, KnownVersion& executing, const ReceivedReport& robot_report,
                       const msg::Feedback& feedback, const Reception& reception);
  void check_switch(const AuditedRobot& robot, const KnownVersion& to, const ReceivedReport& robot_report);
  void check_sent(AuditedRobot& robot, KnownVersion& executing);
  /// Excludes the versions that the report proves are no longer executed.
  void exclude(AuditedRobot& robot, const ReceivedReport& robot_report, const Reception& reception) const;

  const AuditedRun& run_;
  RobotRecords& robots_;
  EpochAudit& epochs_;
  ContentAudit& content_;
  PairAudit& pairs_;
  AuditFindings& findings_;
  MotionAudit motion_;
};

}  // namespace sidestep
