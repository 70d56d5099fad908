// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deploy/audit/message_times.hpp"
#include "deploy/audit/reception_coverage.hpp"
#include "deploy/audit/robot_records.hpp"

namespace sidestep {

/// Measures how much of the run the audit covered, and knows which reference it uses.
class RunCoverage {
 public:
  RunCoverage(const AuditedRun& run, RobotRecords& robots, AuditFindings& findings)
      : run_(run), robots_(robots), findings_(findings), report_coverage_(robots.all().size()) {}

  /// Called when a message shows that robots may move. Once every robot has been heard, or after a second at
  /// the latest, silence lowers the coverage.
  void begin_run();
  void hear_ledger() { has_heard_ledger_ = true; }
  /// Records a report. Precondition: robot.last_report is the report before it.
  void hear_robot_report(const AuditedRobot& robot, VersionNumber executing, const Reception& reception);
  /// Excuses the robot's next silence.
  void expect_silence(const AuditedRobot& robot) { report_coverage_.expect_silence(robots_.index_of(robot)); }

  void use_reference(AuditReference reference);
  bool has_ground_truth() const;
  bool is_vision() const { return findings_.totals.reference == AuditReference::kVision; }
  /// Records an observation of a robot that vision shows (`source`: its index) or of ground truth (0).
  void hear_reference(std::size_t source, Duration unheard) {
    reference_coverage_->hear(source, findings_.now, unheard);
  }

  void add_to(AuditTotals& totals, const MessageTimes& times) const;

 private:
  const AuditedRun& run_;
  RobotRecords& robots_;
  AuditFindings& findings_;
  bool has_heard_ledger_ = false;
  std::optional<Time> motion_sign_at_, begun_at_;  ///< first sign that robots may move; start of the period
  ReceptionCoverage report_coverage_;              ///< reports of all robots
  std::optional<ReceptionCoverage> reference_coverage_;
};

}  // namespace sidestep
