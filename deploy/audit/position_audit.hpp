// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deploy/audit/disturbances.hpp"
#include "deploy/audit/run_coverage.hpp"

namespace sidestep {

/// Checks that robots are where their versions prescribe, according to the reference.
class PositionAudit {
 public:
  PositionAudit(const AuditedRun& run, const RobotRecords& robots, const RunCoverage& coverage,
                const Disturbances& disturbances, AuditFindings& findings);

  /// Stores the robots that the granting coordinator names as displaced.
  void on_displaced(std::vector<RobotId> robots) { named_displaced_ = std::move(robots); }
  /// Compares the robot's pending observation with a new report. Precondition: robot.last_report is the
  /// report before it.
  void check(AuditedRobot& robot, const AuditedRobot::ReceivedReport& robot_report,
             const Reception& reception);
  /// Time since which vision has always seen the robot in place; kNever: unknown.
  std::int64_t in_place_since_ns(std::size_t robot) const { return displacements_[robot].in_place_since_ns; }

 private:
  /// A displacement that vision shows.
  struct SeenDisplacement {
    /// Time since which the robot has always been seen out of place.
    std::int64_t since_ns = kNever;
    bool is_reported = false;  ///< ensures that it is reported only once
    /// Time since which the robot has always been seen in place; kNever: unknown.
    std::int64_t in_place_since_ns = kNever;
  };

  bool is_known_to_be_displaced(std::size_t robot) const;
  void check_true_position(const AuditedRobot& robot, const KnownVersion& executed, double error_m,
                           std::int64_t at_ns);
  void check_seen_position(const AuditedRobot& robot, const KnownVersion& executed, double error_m,
                           std::int64_t at_ns);

  const AuditedRun& run_;
  const RobotRecords& robots_;
  const RunCoverage& coverage_;
  const Disturbances& disturbances_;
  AuditFindings& findings_;
  std::vector<SeenDisplacement> displacements_;  ///< parallel to the robots
  std::vector<RobotId> named_displaced_;
};

}  // namespace sidestep
