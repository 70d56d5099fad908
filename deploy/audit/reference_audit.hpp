// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/audit/truth_audit.hpp"
#include "deploy/audit/vision_audit.hpp"

namespace sidestep {

/// Audits the robots' positions and contacts by the reference, which is ground truth or vision.
class ReferenceAudit {
 public:
  ReferenceAudit(const AuditedRun& run, RobotRecords& robots, RunCoverage& coverage, AuditFindings& findings);

  void on_truth(const msg::GroundTruth& truth, const Reception& reception) {
    truth_.on_truth(truth, reception);
  }
  /// Audits vision's observations. Precondition: there is no ground truth.
  void on_world_state(const msg::WorldState& world, const Reception& reception) {
    vision_.on_world_state(world, reception);
  }
  void on_disturbance(const msg::Disturbance& disturbance);
  /// Call if messages that may have announced disturbances were missed.
  void on_missed() { disturbances_.on_missed(); }
  PositionAudit& positions() { return positions_; }
  void add_to(AuditTotals& totals) const { excuses_.add_to(totals); }

 private:
  RobotRecords& robots_;
  RunCoverage& coverage_;
  AuditFindings& findings_;
  Disturbances disturbances_;
  PositionAudit positions_;
  ContactExcuses excuses_;
  TruthAudit truth_;
  VisionAudit vision_;
};

}  // namespace sidestep
