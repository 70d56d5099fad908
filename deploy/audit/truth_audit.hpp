// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "deploy/audit/contact_excuses.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Reads positions, disturbances, contacts, crashes and the findings of the simulator's firmware monitor from
/// ground truth.
class TruthAudit {
 public:
  TruthAudit(const AuditedRun& run, RobotRecords& robots, RunCoverage& coverage, Disturbances& disturbances,
             ContactExcuses& excuses, AuditFindings& findings)
      : run_(run),
        robots_(robots),
        coverage_(coverage),
        disturbances_(disturbances),
        excuses_(excuses),
        findings_(findings) {}

  void on_truth(const msg::GroundTruth& truth, const Reception& reception);

 private:
  void record_positions(const msg::GroundTruth& truth);
  /// Reports new contacts. `reported` is the number of contacts in the previous ground truth. If
  /// `is_joining`, the auditor joins the run with this ground truth.
  void check_contacts(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining);
  /// Reports new crashes. `reported` is the number of crashes of moving robots in the previous ground truth.
  void check_crashes(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining);
  /// Any robot, to name in a violation whose robot is unknown; `none` if the roster is empty.
  RobotId any_robot(RobotId none) const { return robots_.all().empty() ? none : robots_.all().front().id; }

  const AuditedRun& run_;
  RobotRecords& robots_;
  RunCoverage& coverage_;
  Disturbances& disturbances_;
  ContactExcuses& excuses_;
  AuditFindings& findings_;
  std::map<std::uint64_t, msg::GroundTruth> truths_;  ///< the latest counters of each simulator incarnation
};

}  // namespace sidestep
