// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "deploy/audit/audit_findings.hpp"
#include "deploy/audit/audited_robot.hpp"
#include "deploy/audit/audited_run.hpp"

namespace sidestep {

/// The auditor's records of the robots on the roster and their versions. Reports a violation if two messages
/// give one version different contents.
class RobotRecords {
 public:
  RobotRecords(const AuditedRun& run, AuditFindings& findings);

  /// The robot's record; nullptr if the robot is not on the roster.
  AuditedRobot* find(RobotId id) {
    const auto index = index_of(id);
    return index ? &robots_[*index] : nullptr;
  }
  /// The robot's index; nullopt if the robot is not on the roster.
  std::optional<std::size_t> index_of(RobotId id) const {
    if (id >= index_.size() || index_[id] == robots_.size()) return std::nullopt;
    return index_[id];
  }
  std::size_t index_of(const AuditedRobot& robot) const {
    return static_cast<std::size_t>(&robot - robots_.data());
  }
  std::vector<AuditedRobot>& all() { return robots_; }  ///< sorted by id; their number is fixed
  const std::vector<AuditedRobot>& all() const { return robots_; }

  /// Stores the version's content and returns its record; nullptr if the content is invalid.
  KnownVersion* store(AuditedRobot& robot, const msg::Version& version);
  /// The content of a version's base; nullptr if it was not received. A restarted agent may reuse numbers of
  /// versions that its predecessor proposed without success.
  const KnownVersion* base_of(const AuditedRobot& robot, const KnownVersion& known) const;
  /// The maximum inflation of all versions received so far.
  double max_inflation_m() const { return max_inflation_m_; }

 private:
  const AuditedRun& run_;
  AuditFindings& findings_;
  std::vector<AuditedRobot> robots_;
  std::vector<std::size_t> index_;  ///< indexed by id; robots_.size(): not on the roster
  double max_inflation_m_ = 0;
};

}  // namespace sidestep
