// SPDX-License-Identifier: Apache-2.0
// How much of the run the auditor covered, and its totals.
#include <algorithm>
#include <limits>

#include "deploy/audit/auditor.hpp"

namespace sidestep {
namespace {

// Bound against overflow: four hours of facts.
constexpr std::uint64_t kMaxMissed = 1'000'000;
// An auditor that joins a run finds the senders one after another.
constexpr Duration kMaxJoinTime = std::chrono::seconds(1);

}  // namespace

void Auditor::begin_run() {
  if (begun_at_) return;
  if (!motion_sign_at_) motion_sign_at_ = now_;
  const auto is_heard = [](const AuditedRobot& robot) { return robot.last_report.has_value(); };
  if (!std::ranges::all_of(robots_, is_heard) && now_ - *motion_sign_at_ < kMaxJoinTime) return;
  begun_at_ = now_;
  report_coverage_.begin(now_);
  if (reference_coverage_) reference_coverage_->begin(now_);
}

void Auditor::hear_robot_report(const AuditedRobot& robot, VersionNumber executing,
                                const Reception& reception) {
  if (executing != 0) begin_run();
  // A running robot sends at least one fact per cycle, so this many missed facts span at most as many cycles.
  // They leave no doubt if all versions that the robot executed in between are known.
  const bool is_known = robot.last_report && robot.continues(robot.last_report->executing, executing);
  const auto missed = static_cast<std::int64_t>(std::min(reception.missed, kMaxMissed));
  report_coverage_.hear(index_of(robot), now_, is_known ? Duration{0} : missed * scenario_.cycle);
}

void Auditor::on_attestation(const msg::AbsenceAttestation& attestation, Time now) {
  now_ = now;
  const auto index = roster_index(attestation.robot());
  if (!index) {
    ++totals_.invalid;
    return;
  }
  report_coverage_.expect_silence(*index);
  robots_[*index].attested_until = std::numeric_limits<Epoch>::max();
  robots_[*index].attested_in = newest_epoch_;
}

bool Auditor::has_ground_truth() const {
  return totals_.reference == AuditReference::kGroundTruth ||
         totals_.reference == AuditReference::kVisionThenGroundTruth;
}

void Auditor::use_reference(AuditReference reference) {
  const bool is_vision = reference == AuditReference::kVision;
  const bool was_vision = totals_.reference == AuditReference::kVision;
  totals_.reference = was_vision ? AuditReference::kVisionThenGroundTruth : reference;
  reference_coverage_.emplace(is_vision ? robots_.size() : 1);
  if (begun_at_) reference_coverage_->begin(now_);
  std::ranges::fill(observations_, Observation());
}

Coverage Auditor::coverage() const {
  AuditedRobot::ExecutedVersions versions;
  for (const AuditedRobot& robot : robots_) {
    const auto executed = robot.executed_versions();
    versions.all += executed.all;
    versions.traced += executed.traced;
  }
  Coverage coverage;
  // Agents' messages are judged by their effect, as versions; those of a host that is cut off have no effect.
  const std::uint64_t distinct = trace_.distinct();
  coverage.messages = distinct > 0 ? share_of(distinct, distinct + trace_.missed()) : 0;
  coverage.versions = share_of(versions.traced, versions.all);
  coverage.pairs = share_of(totals_.compared_pairs - totals_.undecided_pairs, totals_.compared_pairs);
  // An auditor that receives every message knows that a silent robot has sent nothing.
  coverage.time = report_coverage_.share(now_, !input_.is_complete);
  const bool counts_silence = !input_.is_complete || !has_ground_truth();
  if (reference_coverage_) coverage.reference = reference_coverage_->share(now_, counts_silence);
  return coverage;
}

AuditTotals Auditor::totals() const {
  AuditTotals totals = totals_;
  totals.received = trace_.received() + agent_trace_.received();
  totals.missed = trace_.missed() + agent_trace_.missed();
  totals.coverage = coverage();
  if (begun_at_) totals.run_s = std::max(0.0, to_seconds(now_ - *begun_at_));
  for (const auto& [key, contacts] : excused_) {
    const auto& [cause, first, second] = key;
    totals.excused.push_back({std::string(cause), first, second, contacts});
  }
  totals.pair_s = disturbances_.pair_s();
  totals.excused_pair_s = disturbances_.excused_pair_s();
  return totals;
}

}  // namespace sidestep
