// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/audit/auditor.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"

namespace sidestep {

/// The objects that judge a run whose scenario is known.
struct RunAssessment {
  RunMetrics metrics;
  Auditor auditor;

  /// The scenario must outlive this object.
  RunAssessment(const Scenario& scenario, const AuditInput& input)
      : metrics(scenario), auditor(scenario, input) {
    metrics.set_auditor(auditor);
  }
  RunAssessment(const RunAssessment&) = delete;
  RunAssessment& operator=(const RunAssessment&) = delete;

  void on(const msg::Proposal& m, Time now) { auditor.on_proposal(m, now); }
  void on(const msg::Verdict& m, Time now) { auditor.on_verdict(m, now); }
  void on(const msg::Registration& m, Time now) { auditor.on_registration(m, now); }
  void on(const msg::CoordinatorState& m, Time now) {
    auditor.on_coordinator(m, now);
    metrics.on_coordinator(m);
  }
  void on(const msg::LedgerPage& m, Time now) { auditor.on_ledger(m, now); }
  void on(const msg::Command& m, Time now) { auditor.on_command(m, now); }
  void on(const msg::Feedback& m, Time now) { auditor.on_robot_report(m, now); }
  void on(const msg::GroundTruth& m, Time now) {
    auditor.on_truth(m, now);
    metrics.on_truth(m);
  }
  void on(const msg::WorldState& m, Time now) { auditor.on_world_state(m, now); }
  void on(const msg::Disturbance& m, Time now) { auditor.on_disturbance(m, now); }
  void on(const msg::AbsenceAttestation& m, Time now) { auditor.on_attestation(m, now); }
  void on(const msg::AgentStatus& m, Time) { metrics.on_status(m); }
  void on(const msg::Counters& m, Time) { metrics.on_counters(m); }
};

}  // namespace sidestep
