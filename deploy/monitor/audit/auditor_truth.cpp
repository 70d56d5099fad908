// SPDX-License-Identifier: Apache-2.0
// Checks against ground truth: positions, contacts, crashes, and the simulator's own firmware monitor.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/monitor/audit/auditor.hpp"
#include "deploy/monitor/time_range.hpp"

namespace sidestep {
namespace {

// Robots in contact may appear this far apart, because their positions are sampled.
constexpr double kContactTolerance_m = 0.001;
constexpr std::size_t kMaxSimulatorLives = 16;

}  // namespace

void Auditor::check_position(AuditedRobot& robot, const msg::Feedback& feedback, const Reception& reception) {
  Observation& pending = observations_[index_of(robot)];
  if (!input_.is_complete || pending.at_ns == kNever) return;
  const std::int64_t clock_offset_ns = feedback.valid_at_ns() - reception.latest_ns;
  const std::int64_t at_ns = pending.at_ns + clock_offset_ns;  // by the robot's clock
  if (feedback.valid_at_ns() < at_ns) return;
  const Observation observation = pending;
  pending = {};
  const bool is_off = feedback.is_off_reference() || feedback.is_lifted() || !robot.fact ||
                      robot.fact->is_off_reference || robot.fact->is_lifted;
  const KnownVersion* executed = robot.find(feedback.executing().version_number());
  while (executed && executed->has_content && executed->path.start_ns() > at_ns && executed->number != 0)
    executed = robot.find(executed->version.base());
  if (is_off || !executed || !executed->has_content) return;
  const AuditPath::Node reference = executed->path.at_ns(at_ns);
  const double error = std::hypot(observation.x - reference.x, observation.y - reference.y);
  const double bound = tracking_bound_m_ + executed->version.inflation_m();
  totals_.max_position_error_m = std::max(totals_.max_position_error_m, error);
  totals_.beyond_tracking_bound += error > bound;
  if (error <= bound) disturbances_.confirm_in_place(index_of(robot));
  if (error <= scenario_.margin_m + executed->version.inflation_m()) return;
  if (disturbances_.is_disturbed(index_of(robot))) {
    ++totals_.excused_displacements;
    return;
  }
  report(AuditRule::kPosition, robot.id, executed, 0,
         fmt::format("is {:.6f} m from its reference at {} ns; the margin is {:.6f} m", error, at_ns,
                     scenario_.margin_m));
}

void Auditor::check_contacts(const msg::GroundTruth& truth, std::uint64_t reported) {
  const std::uint64_t added = truth.contacts() - reported,
                      listed = std::min<std::uint64_t>(added, msg::MAX_CONTACTS);
  bool are_all_excused = true;
  for (std::uint64_t k = truth.contacts() - listed; k < truth.contacts(); ++k) {
    const msg::ContactPair& contact = truth.recent_contacts()[k % msg::MAX_CONTACTS];
    if (disturbances_.on_contact(roster_index(contact.first()), roster_index(contact.second()))) {
      ++totals_.excused_contacts;
      continue;
    }
    are_all_excused = false;
    const std::string touched =
        contact.second() == msg::NO_ROBOT ? "an obstacle" : fmt::format("robot {}", contact.second());
    report(
        AuditRule::kContact, contact.first(), nullptr, 0,
        fmt::format("touches {}; {} contacts so far, {:.9f} m s of penetration, minimum clearance {:.6f} m",
                    touched, truth.contacts(), truth.penetration_m_s(), truth.min_clearance_m()));
  }
  // Contacts beyond the list are excused if all listed ones are.
  if (are_all_excused) totals_.excused_contacts += added - listed;
}

std::optional<std::size_t> Auditor::roster_index(RobotId robot) const {
  if (robot >= index_.size() || index_[robot] == robots_.size()) return std::nullopt;
  return index_[robot];
}

void Auditor::on_truth(const msg::GroundTruth& truth, Time now) {
  now_ = now;
  const Reception reception = trace(kTruthKind, truth.simulator(), truth.header());
  if (!is_valid_time(truth.valid_at_ns()) || truth.robots().size() > kMaxRobots) {
    ++totals_.invalid;
    return;
  }
  if (!reception.is_newest) return;
  if (truths_.size() >= kMaxSimulatorLives && !truths_.contains(truth.header().incarnation()))
    truths_.erase(truths_.begin());
  record_positions(truth);
  msg::GroundTruth& last = truths_[truth.header().incarnation()];
  const RobotId any_robot = robots_.empty() ? 0 : robots_.front().id;
  if (truth.contacts() > last.contacts()) check_contacts(truth, last.contacts());
  if (truth.firmware_violations() > last.firmware_violations())
    report(AuditRule::kFirmwareMonitor, any_robot, nullptr, 0,
           fmt::format("{} violations so far", truth.firmware_violations()));
  if (truth.crashes_while_moving() > last.crashes_while_moving()) {
    report(AuditRule::kCrash, any_robot, nullptr, 0,
           fmt::format("{} crashes of moving robots so far, at a robot speed of up to {:.3f} m/s",
                       truth.crashes_while_moving(), truth.max_robot_crash_speed_mps()));
  }
  last.contacts(truth.contacts());
  last.firmware_violations(truth.firmware_violations());
  last.crashes_while_moving(truth.crashes_while_moving());
}

void Auditor::record_positions(const msg::GroundTruth& truth) {
  const Time at = time_from_ns(truth.valid_at_ns());
  std::ranges::fill(positions_m_, std::nullopt);
  for (const msg::TrueRobotState& state : truth.robots()) {
    const auto index = roster_index(state.robot());
    if (!index || !std::isfinite(state.x_m()) || !std::isfinite(state.y_m())) continue;
    observations_[*index] = {truth.valid_at_ns(), state.x_m(), state.y_m()};
    positions_m_[*index] = Vec2(state.x_m(), state.y_m());
    if (state.disturbance_end_ns() >= 0)
      disturbances_.disturb(*index, time_from_ns(state.disturbance_end_ns()), at);
  }
  disturbances_.update(at, positions_m_, 2 * scenario_.radius_m + kContactTolerance_m);
}

}  // namespace sidestep
