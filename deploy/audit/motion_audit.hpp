// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/audit/robot_records.hpp"

namespace sidestep {

/// Checks what robots report of their own motion: the distance from their reference, and their own stops.
class MotionAudit {
 public:
  MotionAudit(const AuditedRun& run, AuditFindings& findings) : run_(run), findings_(findings) {}

  /// Precondition: `robot_report` is decoded from `feedback`, and robot.last_report is the report before it.
  void check_tracking(AuditedRobot& robot, const KnownVersion& executing,
                      const AuditedRobot::ReceivedReport& robot_report, const msg::Feedback& feedback,
                      const Reception& reception);
  void check_own_stop(const AuditedRobot& robot, const KnownVersion& own_stop, std::int64_t lead_ns);

 private:
  const AuditedRun& run_;
  AuditFindings& findings_;
};

}  // namespace sidestep
