// SPDX-License-Identifier: Apache-2.0
// Checks against what vision sees, for systems without ground truth: positions and contacts.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/messaging/enumerator.hpp"
#include "deploy/audit/auditor.hpp"
#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

// Ground truth would have arrived within this time.
constexpr Duration kGroundTruthWait = std::chrono::seconds(1);
// A robot that was moved learns that from vision, and then reports that it is off its reference.
constexpr std::int64_t kMaxSeenDisplacement_ns = 300'000'000;
constexpr std::int64_t kMaxDisturbance_ns = 3'600'000'000'000;

bool is_sane(const msg::TrackedRobot& robot) {
  return std::isfinite(robot.x_m()) && std::isfinite(robot.y_m()) && std::isfinite(robot.vx_mps()) &&
         std::isfinite(robot.vy_mps()) && std::isfinite(robot.observed_x_m()) &&
         std::isfinite(robot.observed_y_m()) && is_valid_time(robot.observed_at_ns());
}

}  // namespace

void Auditor::on_disturbance(const msg::Disturbance& disturbance, Time now) {
  now_ = now;
  const auto index = roster_index(disturbance.robot());
  const msg::DisturbanceKind kind = disturbance.disturbance_kind();
  if (!index || !is_enumerator(kind, msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN)) {
    ++totals_.invalid;
    return;
  }
  if (kind == msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF) report_coverage_.expect_silence(*index);
  const auto cause = cause_of(kind);
  if (!cause) return;
  disturbances_.announce(*index, *cause);
  const auto other = kind == msg::DisturbanceKind::DISTURBANCE_SEEN_AS
                         ? roster_index(disturbance.other_robot())
                         : std::nullopt;
  if (other) disturbances_.announce(*other, *cause);
  if (has_ground_truth()) return;
  const auto duration_ns = std::clamp<std::int64_t>(disturbance.duration_ns(), 0, kMaxDisturbance_ns);
  disturbances_.disturb(*index, now + Duration{duration_ns}, now);
}

void Auditor::on_world_state(const msg::WorldState& world, Time now) {
  now_ = now;
  if (has_ground_truth()) return;
  const Reception reception = trace(kWorldKind, world.vision(), world.header());
  if (!is_valid_time(world.valid_at_ns()) || world.robots().size() > kMaxRobots) {
    ++totals_.invalid;
    return;
  }
  if (!reception.is_newest) return;
  if (!input_.is_complete && reception.missed > 0) {
    disturbances_.on_reference_missed();
    seen_contacts_.on_missed();
  }
  record_sights(world);
  if (!fall_back_to_vision()) return;
  const Time at = time_from_ns(world.valid_at_ns());
  for (const SeenContact& contact : seen_contacts_.update(sights_)) {
    const RobotId first = robots_[contact.first].id;
    const std::optional<RobotId> second =
        contact.second ? std::optional(robots_[*contact.second].id) : std::nullopt;
    if (is_excused_contact(first, second, at, contact.apart_ns)) continue;
    report(AuditRule::kContact, first, nullptr, 0,
           second ? fmt::format("touches robot {}, as vision shows: {:.6f} m between the centres", *second,
                                contact.distance_m)
                  : fmt::format("touches an obstacle, as vision shows: its centre is {:.6f} m from the edge",
                                contact.distance_m));
  }
  check_sights(world);
  disturbances_.update(at, observed_);
}

void Auditor::record_sights(const msg::WorldState& world) {
  for (Sight& sight : sights_) sight.is_new = false;
  for (const msg::TrackedRobot& robot : world.robots()) {
    const auto index = roster_index(robot.robot());
    if (!index || !is_sane(robot)) {
      ++totals_.invalid;
      continue;
    }
    Sight& sight = sights_[*index];
    if (robot.observed_at_ns() <= sight.observed_at_ns) continue;
    sight = {robot.observed_at_ns(),
             {robot.observed_x_m(), robot.observed_y_m()},
             {robot.vx_mps(), robot.vy_mps()},
             true};
  }
}

bool Auditor::fall_back_to_vision() {
  if (totals_.reference == AuditReference::kVision) return true;
  if (!first_sight_at_ && std::ranges::any_of(sights_, &Sight::is_new)) first_sight_at_ = now_;
  if (!first_sight_at_ || now_ - *first_sight_at_ < kGroundTruthWait) return false;
  use_reference(AuditReference::kVision);
  return true;
}

void Auditor::check_sights(const msg::WorldState& world) {
  std::ranges::fill(observed_, std::nullopt);
  for (const msg::TrackedRobot& tracked : world.robots()) {
    const auto index = roster_index(tracked.robot());
    if (!index || !is_sane(tracked)) continue;
    const Sight& sight = sights_[*index];
    if (sight.is_new)
      observations_[*index] = {sight.observed_at_ns, sight.position_m.x(), sight.position_m.y(), 0};
    const double error_m = seen_error_m(*index, sight.position_m, sight.observed_at_ns);
    observed_[*index] = observed_robot(*index, {tracked.x_m(), tracked.y_m()}, sight.velocity_mps.norm(),
                                       error_m, sight_allowance_m_);
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    // Vision does not see a robot that is not on the floor.
    const bool is_lifted = robots_[i].last_report && robots_[i].last_report->is_lifted;
    if (is_lifted || sights_[i].is_new)
      reference_coverage_->hear(i, now_, is_lifted ? Duration{0} : Duration::max());
  }
}

double Auditor::seen_error_m(std::size_t index, const Vec2& position_m, std::int64_t at_ns) const {
  const AuditedRobot& robot = robots_[index];
  const KnownVersion* const executed =
      robot.last_report ? executed_at(robot, robot.last_report->executing, at_ns) : nullptr;
  if (!executed) return INFINITY;
  const AuditPath::Node place = executed->path.at_ns(at_ns);
  return std::hypot(position_m.x() - place.x, position_m.y() - place.y);
}

void Auditor::check_seen_position(const AuditedRobot& robot, const KnownVersion& executed, double error_m,
                                  std::int64_t at_ns) {
  SeenDisplacement& displacement = seen_displacements_[index_of(robot)];
  const double bound_m = tracking_bound_m_ + executed.version.inflation_m() + sight_allowance_m_;
  if (error_m <= bound_m) {
    const bool was_in_place = displacement.in_place_since_ns != kNever && displacement.since_ns == kNever;
    displacement = {kNever, false, was_in_place ? displacement.in_place_since_ns : at_ns};
    return;
  }
  // An auditor that joins a run does not know what displaced a robot earlier.
  if (!input_.is_complete && displacement.in_place_since_ns == kNever) return;
  if (is_known_to_be_displaced(robot)) {
    ++totals_.excused_displacements;
    return;
  }
  if (displacement.since_ns == kNever) displacement.since_ns = at_ns;
  if (displacement.is_reported || at_ns - displacement.since_ns <= kMaxSeenDisplacement_ns) return;
  displacement.is_reported = true;
  report(AuditRule::kPosition, robot.id, &executed, 0,
         fmt::format("is {:.6f} m from its reference at {} ns, as vision shows; {:.6f} m allowed", error_m,
                     at_ns, bound_m));
}

}  // namespace sidestep
