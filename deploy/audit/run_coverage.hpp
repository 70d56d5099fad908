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

  /// A message shows that robots may move. Once every robot has been heard, or after a second at the latest,
  /// silence lowers the coverage.
  void begin_run();
  /// Precondition: robot.last_report is the report before this one.
  void hear_robot_report(const AuditedRobot& robot, VersionNumber executing, const Reception& reception);
  /// The robot's next silence does not count.
  void expect_silence(const AuditedRobot& robot) { report_coverage_.expect_silence(robots_.index_of(robot)); }

  void use_reference(AuditReference reference);
  bool has_ground_truth() const;
  bool is_vision() const { return findings_.totals.reference == AuditReference::kVision; }
  /// `source` is the index of the robot that vision shows, or 0 for ground truth; see ReceptionCoverage.
  void hear_reference(std::size_t source, Duration unheard) {
    reference_coverage_->hear(source, findings_.now, unheard);
  }

  void add_to(AuditTotals& totals, const MessageTimes& times) const;

 private:
  const AuditedRun& run_;
  RobotRecords& robots_;
  AuditFindings& findings_;
  std::optional<Time> motion_sign_at_, begun_at_;  ///< when a message first showed that robots may move
  ReceptionCoverage report_coverage_;              ///< reports of all robots
  std::optional<ReceptionCoverage> reference_coverage_;
};

}  // namespace sidestep
