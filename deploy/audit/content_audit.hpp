// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deploy/audit/audit_shape.hpp"
#include "deploy/audit/robot_records.hpp"

namespace sidestep {

/// Checks the content of granted versions: the motion itself, and its relation to the field, the obstacles
/// and the version's base.
class ContentAudit {
 public:
  ContentAudit(const AuditedRun& run, const RobotRecords& robots, AuditFindings& findings);

  /// Runs all checks of a version. Precondition, here and below: the version has content.
  void check(const AuditedRobot& robot, KnownVersion& known);
  /// Runs the checks that need the version's base, if the base is known.
  void check_against_base(const AuditedRobot& robot, KnownVersion& known);

 private:
  void check_limits(const AuditedRobot& robot, const KnownVersion& known);
  void check_field(const AuditedRobot& robot, const KnownVersion& known, const KnownVersion* base);
  void check_obstacles(const AuditedRobot& robot, const KnownVersion& known, const KnownVersion* base);
  void check_obstacle(const AuditedRobot& robot, const KnownVersion& known, const KnownVersion* base,
                      const AuditShape& obstacle, const Shape& shape, bool is_map);
  double distance_of_base_m(const KnownVersion& base, const AuditShape& obstacle, bool is_map,
                            double required_m) const;
  void check_base(const AuditedRobot& robot, const KnownVersion& known);
  /// Required distance of the robot's centre from the edge of an obstacle.
  double required_separation_m(const KnownVersion& known) const {
    return run_.scenario.radius_m + run_.scenario.margin_m + known.version.inflation_m();
  }

  const AuditedRun& run_;
  const RobotRecords& robots_;
  AuditFindings& findings_;
  std::vector<AuditShape> obstacles_;  ///< parallel to the scenario's obstacles
};

}  // namespace sidestep
