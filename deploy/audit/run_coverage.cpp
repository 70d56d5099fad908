// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/run_coverage.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// Limit that prevents an overflow: the number of reports that a robot sends in four hours.
constexpr std::uint64_t kMaxMissed = 1'000'000;
// An auditor that joins a run discovers all senders within this time.
constexpr Duration kMaxJoinTime = std::chrono::seconds(1);

}  // namespace

void RunCoverage::begin_run() {
  if (begun_at_) return;
  if (!motion_sign_at_) motion_sign_at_ = findings_.now;
  const auto is_heard = [](const AuditedRobot& robot) { return robot.last_report.has_value(); };
  if (!std::ranges::all_of(robots_.all(), is_heard) && findings_.now - *motion_sign_at_ < kMaxJoinTime)
    return;
  begun_at_ = findings_.now;
  report_coverage_.begin(findings_.now);
  if (reference_coverage_) reference_coverage_->begin(findings_.now);
}

void RunCoverage::hear_robot_report(const AuditedRobot& robot, VersionNumber executing,
                                    const Reception& reception) {
  if (executing != 0) begin_run();
  // A running robot sends at least one report per cycle, so n missed reports span at most n cycles. Missed
  // reports do not matter if all versions that the robot executed in between are known.
  const bool is_known = robot.last_report && robot.continues(robot.last_report->executing, executing);
  const auto missed = static_cast<std::int64_t>(std::min(reception.missed, kMaxMissed));
  report_coverage_.hear(robots_.index_of(robot), findings_.now,
                        is_known ? Duration{0} : missed * run_.scenario.cycle);
}

bool RunCoverage::has_ground_truth() const {
  return findings_.totals.reference == AuditReference::kGroundTruth ||
         findings_.totals.reference == AuditReference::kVisionThenGroundTruth;
}

void RunCoverage::use_reference(AuditReference reference) {
  const bool is_vision = reference == AuditReference::kVision;
  const bool was_vision = findings_.totals.reference == AuditReference::kVision;
  findings_.totals.reference = was_vision ? AuditReference::kVisionThenGroundTruth : reference;
  reference_coverage_.emplace(is_vision ? robots_.all().size() : 1);
  if (begun_at_) reference_coverage_->begin(findings_.now);
  for (AuditedRobot& robot : robots_.all()) robot.observation = {};
}

void RunCoverage::add_to(AuditTotals& totals, const MessageTimes& times) const {
  AuditedRobot::ExecutedVersions versions, first;
  for (const AuditedRobot& robot : robots_.all()) {
    versions += robot.executed_versions();
    first += robot.first_executed_versions();
  }
  // If no version was certainly granted during the audit, the audit must know all those that may have been.
  if (versions.all == 0) {
    versions = first;
    totals.untraced_first_versions = first.all - first.traced;
  }
  Coverage& coverage = totals.coverage;
  // Agents' messages count only through their effect (see coverage.versions), because messages from a host
  // that is cut off have no effect.
  const std::uint64_t distinct = times.trace().distinct();
  coverage.messages = distinct > 0 ? share_of(distinct, distinct + times.trace().missed()) : 0;
  coverage.versions = share_of(versions.traced, versions.all);
  coverage.pairs = share_of(totals.compared_pairs - totals.undecided_pairs, totals.compared_pairs);
  // An auditor that receives every message knows that a silent robot has sent nothing.
  coverage.time = report_coverage_.share(findings_.now, !run_.is_complete());
  const bool counts_silence = !run_.is_complete() || !has_ground_truth();
  if (reference_coverage_) coverage.reference = reference_coverage_->share(findings_.now, counts_silence);
  totals.received = times.trace().received() + times.agent_trace().received();
  totals.missed = times.trace().missed() + times.agent_trace().missed();
  totals.lacks_ledger = begun_at_ && !has_heard_ledger_;
  if (begun_at_) totals.run_s = std::max(0.0, to_seconds(findings_.now - *begun_at_));
}

}  // namespace sidestep
