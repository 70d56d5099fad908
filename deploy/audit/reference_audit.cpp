// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/reference_audit.hpp"

#include <algorithm>

#include "common/messaging/enumerator.hpp"

namespace sidestep {
namespace {

// Robots in contact may appear this far apart, because their positions are sampled.
constexpr double kContactTolerance_m = 0.001;
// Time for messages and a few cycles, in addition to braking itself.
constexpr Duration kReactionTime = std::chrono::milliseconds(200);
constexpr std::int64_t kMaxDisturbance_ns = 3'600'000'000'000;

DisturbanceSettings disturbance_settings(const Scenario& scenario, bool is_complete) {
  const double braking_s = scenario.limits.speed_mps / scenario.limits.deceleration_mps2;
  return {2 * scenario.radius_m + kContactTolerance_m, 2 * scenario.radius_m + scenario.margin_m,
          from_seconds(braking_s) + kReactionTime, is_complete, scenario.margin_m};
}

}  // namespace

ReferenceAudit::ReferenceAudit(const AuditedRun& run, RobotRecords& robots, RunCoverage& coverage,
                               AuditFindings& findings)
    : robots_(robots),
      coverage_(coverage),
      findings_(findings),
      disturbances_(robots.all().size(), disturbance_settings(run.scenario, run.is_complete())),
      positions_(run, robots, coverage, disturbances_, findings),
      excuses_(run, robots, coverage, positions_, disturbances_, findings),
      truth_(run, robots, coverage, disturbances_, excuses_, findings),
      vision_(run, robots, coverage, disturbances_, excuses_, findings) {}

void ReferenceAudit::on_disturbance(const msg::Disturbance& disturbance) {
  const auto index = robots_.index_of(disturbance.robot());
  const msg::DisturbanceKind kind = disturbance.disturbance_kind();
  if (!index || !is_enumerator(kind, msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN)) {
    ++findings_.totals.invalid;
    return;
  }
  if (kind == msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF) coverage_.expect_silence(robots_.all()[*index]);
  const auto cause = cause_of(kind);
  if (!cause) return;
  disturbances_.announce(*index, *cause);
  const auto other = kind == msg::DisturbanceKind::DISTURBANCE_SEEN_AS
                         ? robots_.index_of(disturbance.other_robot())
                         : std::nullopt;
  if (other) disturbances_.announce(*other, *cause);
  if (coverage_.has_ground_truth()) return;
  const auto duration_ns = std::clamp<std::int64_t>(disturbance.duration_ns(), 0, kMaxDisturbance_ns);
  disturbances_.disturb(*index, findings_.now + Duration{duration_ns}, findings_.now);
}

}  // namespace sidestep
