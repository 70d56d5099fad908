// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/truth_audit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxSimulatorLives = 16;

}  // namespace

void TruthAudit::on_truth(const msg::GroundTruth& truth, const Reception& reception) {
  if (!is_valid_time(truth.valid_at_ns()) || truth.robots().size() > kMaxRobots) {
    ++findings_.totals.invalid;
    return;
  }
  if (!reception.is_newest) return;
  if (!coverage_.has_ground_truth()) coverage_.use_reference(AuditReference::kGroundTruth);
  // The counters in ground truth include contacts that happened while no ground truth was received.
  coverage_.hear_reference(0, Duration{0});
  if (truths_.size() >= kMaxSimulatorLives && !truths_.contains(truth.header().incarnation()))
    truths_.erase(truths_.begin());
  record_positions(truth);
  if (!run_.is_complete() && reception.missed > 0) disturbances_.on_reference_missed();
  const bool is_joining =
      !run_.is_complete() && reception.missed > 0 && !truths_.contains(truth.header().incarnation());
  msg::GroundTruth& last = truths_[truth.header().incarnation()];
  if (truth.contacts() > last.contacts()) check_contacts(truth, last.contacts(), is_joining);
  excuses_.end_observation(time_from_ns(truth.valid_at_ns()));
  if (truth.firmware_violations() > last.firmware_violations())
    findings_.report(AuditRule::kFirmwareMonitor, any_robot(0), nullptr, 0, "{} violations so far",
                     truth.firmware_violations());
  if (truth.crashes_while_moving() > last.crashes_while_moving())
    check_crashes(truth, last.crashes_while_moving(), is_joining);
  last.contacts(truth.contacts());
  last.firmware_violations(truth.firmware_violations());
  last.crashes_while_moving(truth.crashes_while_moving());
}

void TruthAudit::check_contacts(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining) {
  const std::uint64_t added = truth.contacts() - reported,
                      listed = std::min<std::uint64_t>(added, msg::MAX_CONTACTS);
  findings_.totals.unidentified_contacts += added - listed;
  if (added > listed) excuses_.on_unknown_contacts();
  for (std::uint64_t k = truth.contacts() - listed; k < truth.contacts(); ++k) {
    const msg::ContactPair& contact = truth.recent_contacts()[k % msg::MAX_CONTACTS];
    const std::optional<RobotId> second =
        contact.second() == msg::NO_ROBOT ? std::nullopt : std::optional<RobotId>(contact.second());
    if (excuses_.excuses(contact.first(), second, time_from_ns(truth.valid_at_ns()))) continue;
    if (is_joining) {
      ++findings_.totals.undecided_contacts;
      continue;
    }
    const std::string touched = second ? fmt::format("robot {}", *second) : "an obstacle";
    findings_.report(AuditRule::kContact, contact.first(), nullptr, 0,
                     "touches {}; {} contacts so far, {:.9f} m s of penetration, minimum clearance {:.6f} m",
                     touched, truth.contacts(), truth.penetration_m_s(), truth.min_clearance_m());
  }
}

void TruthAudit::check_crashes(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining) {
  for (std::uint64_t k = reported; k < truth.crashes_while_moving(); ++k) {
    const bool is_listed = truth.crashes_while_moving() - k <= msg::MAX_CONTACTS;
    const RobotId robot = truth.recent_moving_crashes()[k % msg::MAX_CONTACTS];
    const auto index = is_listed ? robots_.index_of(robot) : std::nullopt;
    if (index && disturbances_.is_displaced(*index)) {
      ++findings_.totals.excused_crashes;
      continue;
    }
    if (is_joining || !(excuses_.are_known(index) || (run_.is_complete() && !index))) {
      ++findings_.totals.undecided_crashes;
      continue;
    }
    findings_.report(AuditRule::kCrash, index ? robot : any_robot(robot), nullptr, 0,
                     "{} crashes of moving robots so far, at a robot speed of up to {:.3f} m/s",
                     truth.crashes_while_moving(), truth.max_robot_crash_speed_mps());
    // One violation covers all crashes that are not listed.
    if (!is_listed) k = truth.crashes_while_moving() - msg::MAX_CONTACTS - 1;
  }
}

void TruthAudit::record_positions(const msg::GroundTruth& truth) {
  const Time at = time_from_ns(truth.valid_at_ns());
  excuses_.begin_observation();
  for (const msg::TrueRobotState& state : truth.robots()) {
    const auto index = robots_.index_of(state.robot());
    const bool is_finite =
        std::isfinite(state.x_m()) && std::isfinite(state.y_m()) && std::isfinite(state.reference_error_m());
    if (!index || !is_finite) continue;
    AuditedRobot& robot = robots_.all()[*index];
    robot.observation = {truth.valid_at_ns(), state.x_m(), state.y_m(), state.reference_error_m()};
    const bool is_known = state.reference_error_m() >= 0;
    const Vec2 position_m(state.x_m(), state.y_m());
    const double error_m =
        is_known ? state.reference_error_m() : robot.distance_from_version_m(position_m, truth.valid_at_ns());
    excuses_.observe(robot, position_m, std::hypot(state.vx_mps(), state.vy_mps()), error_m,
                     is_known ? 0 : run_.observation_allowance_m());
    if (state.disturbance_end_ns() >= 0)
      disturbances_.disturb(*index, time_from_ns(state.disturbance_end_ns()), at);
  }
}

}  // namespace sidestep
