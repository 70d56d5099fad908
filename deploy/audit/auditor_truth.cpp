// SPDX-License-Identifier: Apache-2.0
// Checks against ground truth: positions, contacts, crashes, and the simulator's own firmware monitor.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "deploy/audit/auditor.hpp"
#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxSimulatorLives = 16;
// Rounding of positions and velocities in messages.
constexpr double kRounding_m = 1e-5;

}  // namespace

void Auditor::check_position(AuditedRobot& robot, const msg::Feedback& feedback, const Reception& reception) {
  const std::size_t index = index_of(robot);
  const bool is_vision = totals_.reference == AuditReference::kVision;
  Observation& pending = observations_[index];
  // A simulator of robots without firmware does not know their references.
  const bool is_seen = is_vision || pending.reference_error_m < 0;
  // If messages may be missed, the delay of facts is unknown, and so is the offset of the robot's clock. It
  // is within bound of the clocks of cameras and of such a simulator.
  const bool is_by_bound = is_vision || (is_seen && !input_.is_complete);
  const std::int64_t ahead_ns = feedback.valid_at_ns() - reception.latest_ns;
  const std::int64_t gained_ns = ahead_ns - std::exchange(robot.clock_ahead_ns, ahead_ns);
  if (pending.at_ns == kNever) return;
  if (input_.is_complete && !is_vision && std::abs(gained_ns) > clock_bound_ns_) {
    // The clock has jumped since the observation, which therefore has no time by this clock.
    pending = Observation();
    return;
  }
  // According to the robot's clock.
  const std::int64_t at_ns = pending.at_ns + (is_by_bound ? 0 : ahead_ns);
  if (feedback.valid_at_ns() < at_ns) return;
  const Observation observation = std::exchange(pending, Observation());
  if (!input_.is_complete && !reception.is_next) {
    // It is unknown what the robot did in that time.
    seen_displacements_[index] = {};
    return;
  }
  const bool is_off = feedback.is_off_reference() || feedback.is_lifted() || !robot.last_report ||
                      robot.last_report->is_off_reference || robot.last_report->is_lifted ||
                      (is_by_bound && !has_sound_clock_[index]);
  const KnownVersion* executed = executed_at(robot, feedback.executing().version_number(), at_ns);
  // An own stop may have been made, and left, between the two facts.
  const bool may_be_off = !input_.is_complete && executed && executed->is_own_stop;
  if (is_off || !executed || may_be_off) {
    seen_displacements_[index] = {};
    return;
  }
  double error_m = observation.reference_error_m, inflation_m = executed->version.inflation_m();
  if (is_seen || input_.is_complete) {
    const AuditPath::Node reference = executed->path.at_ns(at_ns);
    error_m = std::hypot(observation.x - reference.x, observation.y - reference.y);
  } else {
    // Ground truth that arrives late may be older than both facts.
    if (robot.last_report->at_ns > at_ns) return;
    // The times of live messages are not exact enough to say which of the two versions was executed.
    const KnownVersion* const before = robot.find(robot.last_report->executing);
    if (before) inflation_m = std::max(inflation_m, before->version.inflation_m());
  }
  totals_.max_position_error_m = std::max(totals_.max_position_error_m, error_m);
  if (is_seen)
    check_seen_position(robot, *executed, error_m, at_ns);
  else
    check_true_position(robot, *executed, error_m - inflation_m, at_ns);
}

// A robot that cannot use observations, because its clock is off, never learns that it was displaced. Others
// keep clear of it for as long as the coordinator names it.
bool Auditor::is_known_to_be_displaced(const AuditedRobot& robot) const {
  // The coordinator's messages may have been missed.
  if (!input_.is_complete && disturbances_.was_disturbed(index_of(robot))) return true;
  return disturbances_.is_displaced(index_of(robot)) || disturbances_.rests_where_left(index_of(robot)) ||
         (disturbances_.was_disturbed(index_of(robot)) && std::ranges::count(named_displaced_, robot.id) > 0);
}

void Auditor::check_true_position(const AuditedRobot& robot, const KnownVersion& executed, double error_m,
                                  std::int64_t at_ns) {
  if (error_m <= tracking_bound_m_ + kRounding_m) return;
  if (is_known_to_be_displaced(robot)) {
    ++totals_.excused_displacements;
    return;
  }
  report(AuditRule::kPosition, robot.id, &executed, 0,
         fmt::format("is {:.6f} m from its reference, beyond its inflation, at {} ns; {:.6f} m allowed",
                     error_m, at_ns, tracking_bound_m_));
}

const KnownVersion* Auditor::executed_at(const AuditedRobot& robot, VersionNumber latest,
                                         std::int64_t at_ns) {
  const KnownVersion* executed = robot.find(latest);
  while (executed && executed->has_content && executed->path.start_ns() > at_ns && executed->number != 0)
    executed = robot.find(executed->version.base());
  return executed && executed->has_content ? executed : nullptr;
}

bool Auditor::is_excused_contact(RobotId first, std::optional<RobotId> second, Time at,
                                 std::int64_t apart_ns) {
  const auto first_index = roster_index(first),
             second_index = second ? roster_index(*second) : std::optional<std::size_t>();
  const auto cause = disturbances_.on_contact(first_index, second_index, at);
  if (!cause) {
    if (are_excuses_known(first_index, apart_ns) && (!second || are_excuses_known(second_index, apart_ns)))
      return false;
    ++totals_.undecided_contacts;
    return true;
  }
  ++totals_.excused_contacts;
  ++excused_[{*cause, first, second}];
  return true;
}

bool Auditor::are_excuses_known(std::optional<std::size_t> robot, std::int64_t apart_ns) const {
  if (input_.is_complete) return true;
  // A robot that is not seen now may have been disturbed since it was last seen.
  if (!robot || !observed_[*robot] || are_contacts_unknown_ || disturbances_.is_uncertain(*robot))
    return false;
  // When vision is the reference, robots that touch may have done so since one of them was out of place.
  const bool is_vision = totals_.reference == AuditReference::kVision;
  return !is_vision || seen_displacements_[*robot].in_place_since_ns <= apart_ns;
}

void Auditor::check_contacts(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining) {
  const std::uint64_t added = truth.contacts() - reported,
                      listed = std::min<std::uint64_t>(added, msg::MAX_CONTACTS);
  totals_.unidentified_contacts += added - listed;
  if (added > listed) are_contacts_unknown_ = true;
  for (std::uint64_t k = truth.contacts() - listed; k < truth.contacts(); ++k) {
    const msg::ContactPair& contact = truth.recent_contacts()[k % msg::MAX_CONTACTS];
    const std::optional<RobotId> second =
        contact.second() == msg::NO_ROBOT ? std::nullopt : std::optional<RobotId>(contact.second());
    if (is_excused_contact(contact.first(), second, time_from_ns(truth.valid_at_ns()))) continue;
    if (is_joining) {
      ++totals_.undecided_contacts;
      continue;
    }
    const std::string touched = second ? fmt::format("robot {}", *second) : "an obstacle";
    report(
        AuditRule::kContact, contact.first(), nullptr, 0,
        fmt::format("touches {}; {} contacts so far, {:.9f} m s of penetration, minimum clearance {:.6f} m",
                    touched, truth.contacts(), truth.penetration_m_s(), truth.min_clearance_m()));
  }
}

void Auditor::check_crashes(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining) {
  for (std::uint64_t k = reported; k < truth.crashes_while_moving(); ++k) {
    const bool is_listed = truth.crashes_while_moving() - k <= msg::MAX_CONTACTS;
    const RobotId robot = truth.recent_moving_crashes()[k % msg::MAX_CONTACTS];
    const auto index = is_listed ? roster_index(robot) : std::nullopt;
    if (index && disturbances_.on_contact(index, std::nullopt, time_from_ns(truth.valid_at_ns()))) {
      ++totals_.excused_crashes;
      continue;
    }
    if (is_joining || !(are_excuses_known(index) || (input_.is_complete && !index))) {
      ++totals_.undecided_crashes;
      continue;
    }
    report(AuditRule::kCrash, index || robots_.empty() ? robot : robots_.front().id, nullptr, 0,
           fmt::format("{} crashes of moving robots so far, at a robot speed of up to {:.3f} m/s",
                       truth.crashes_while_moving(), truth.max_robot_crash_speed_mps()));
    // A single report covers all crashes that are not listed.
    if (!is_listed) k = truth.crashes_while_moving() - msg::MAX_CONTACTS - 1;
  }
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
  if (!has_ground_truth()) use_reference(AuditReference::kGroundTruth);
  // The ground truth's counters report contacts even if they happened while no ground truth was received.
  reference_coverage_->hear(0, now_, Duration{0});
  if (truths_.size() >= kMaxSimulatorLives && !truths_.contains(truth.header().incarnation()))
    truths_.erase(truths_.begin());
  record_positions(truth);
  if (!input_.is_complete && reception.missed > 0) disturbances_.on_reference_missed();
  const bool is_joining =
      !input_.is_complete && reception.missed > 0 && !truths_.contains(truth.header().incarnation());
  msg::GroundTruth& last = truths_[truth.header().incarnation()];
  const RobotId any_robot = robots_.empty() ? 0 : robots_.front().id;
  if (truth.contacts() > last.contacts()) check_contacts(truth, last.contacts(), is_joining);
  disturbances_.update(time_from_ns(truth.valid_at_ns()), observed_);
  if (truth.firmware_violations() > last.firmware_violations())
    report(AuditRule::kFirmwareMonitor, any_robot, nullptr, 0,
           fmt::format("{} violations so far", truth.firmware_violations()));
  if (truth.crashes_while_moving() > last.crashes_while_moving())
    check_crashes(truth, last.crashes_while_moving(), is_joining);
  last.contacts(truth.contacts());
  last.firmware_violations(truth.firmware_violations());
  last.crashes_while_moving(truth.crashes_while_moving());
}

void Auditor::record_positions(const msg::GroundTruth& truth) {
  const Time at = time_from_ns(truth.valid_at_ns());
  std::ranges::fill(observed_, std::nullopt);
  for (const msg::TrueRobotState& state : truth.robots()) {
    const auto index = roster_index(state.robot());
    const bool is_finite =
        std::isfinite(state.x_m()) && std::isfinite(state.y_m()) && std::isfinite(state.reference_error_m());
    if (!index || !is_finite) continue;
    observations_[*index] = {truth.valid_at_ns(), state.x_m(), state.y_m(), state.reference_error_m()};
    const bool is_known = state.reference_error_m() >= 0;
    const Vec2 position_m(state.x_m(), state.y_m());
    const double error_m =
        is_known ? state.reference_error_m() : seen_error_m(*index, position_m, truth.valid_at_ns());
    observed_[*index] = observed_robot(*index, position_m, std::hypot(state.vx_mps(), state.vy_mps()),
                                       error_m, is_known ? 0 : sight_allowance_m_);
    if (state.disturbance_end_ns() >= 0)
      disturbances_.disturb(*index, time_from_ns(state.disturbance_end_ns()), at);
  }
}

ObservedRobot Auditor::observed_robot(std::size_t index, const Vec2& position_m, double speed_mps,
                                      double error_m, double allowance_m) const {
  const AuditedRobot& robot = robots_[index];
  ObservedRobot observed{position_m, speed_mps, 0, false};
  const bool is_executing = robot.last_report && !robot.last_report->is_lifted;
  const KnownVersion* const version = is_executing ? robot.find(robot.last_report->executing) : nullptr;
  if (!version || !version->has_content) return observed;
  observed.inflation_m = version->version.inflation_m();
  // By now the robot may execute another version.
  const bool is_recent = input_.is_complete || now_ - robot.heard_at <= 2 * scenario_.cycle;
  observed.is_in_place = is_recent && version->was_in_ledger() &&
                         error_m <= tracking_bound_m_ + observed.inflation_m + allowance_m;
  return observed;
}

}  // namespace sidestep
