// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/vision_audit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

// Ground truth arrives within this time if there is any.
constexpr Duration kGroundTruthWait = std::chrono::seconds(1);

bool is_sane(const msg::TrackedRobot& robot) {
  return std::isfinite(robot.x_m()) && std::isfinite(robot.y_m()) && std::isfinite(robot.vx_mps()) &&
         std::isfinite(robot.vy_mps()) && std::isfinite(robot.observed_x_m()) &&
         std::isfinite(robot.observed_y_m()) && is_valid_time(robot.observed_at_ns());
}

}  // namespace

void VisionAudit::on_world_state(const msg::WorldState& world, const Reception& reception) {
  if (!is_valid_time(world.valid_at_ns()) || world.robots().size() > kMaxRobots) {
    ++findings_.totals.invalid;
    return;
  }
  if (!reception.is_newest) return;
  if (!run_.is_complete() && reception.missed > 0) {
    disturbances_.on_reference_missed();
    seen_contacts_.on_missed();
  }
  record_sightings(world);
  if (!try_become_reference()) return;
  const Time at = time_from_ns(world.valid_at_ns());
  check_contacts(at);
  record_positions(world);
  excuses_.end_observation(at);
}

void VisionAudit::record_sightings(const msg::WorldState& world) {
  for (VisionSighting& sight : sightings_) sight.is_new = false;
  for (const msg::TrackedRobot& robot : world.robots()) {
    const auto index = robots_.index_of(robot.robot());
    if (!index || !is_sane(robot)) {
      ++findings_.totals.invalid;
      continue;
    }
    VisionSighting& sight = sightings_[*index];
    if (robot.observed_at_ns() <= sight.observed_at_ns) continue;
    sight = {robot.observed_at_ns(),
             {robot.observed_x_m(), robot.observed_y_m()},
             {robot.vx_mps(), robot.vy_mps()},
             true};
  }
}

bool VisionAudit::try_become_reference() {
  if (coverage_.is_vision()) return true;
  if (!first_sighting_at_ && std::ranges::any_of(sightings_, &VisionSighting::is_new))
    first_sighting_at_ = findings_.now;
  if (!first_sighting_at_ || findings_.now - *first_sighting_at_ < kGroundTruthWait) return false;
  coverage_.use_reference(AuditReference::kVision);
  return true;
}

void VisionAudit::check_contacts(Time at) {
  for (const SeenContact& contact : seen_contacts_.update(sightings_)) {
    const RobotId first = robots_.all()[contact.first].id;
    const std::optional<RobotId> second =
        contact.second ? std::optional(robots_.all()[*contact.second].id) : std::nullopt;
    if (excuses_.excuses(first, second, at, contact.apart_ns)) continue;
    findings_.report(
        AuditRule::kContact, first, nullptr, 0,
        second ? fmt::format("touches robot {}, as vision shows: {:.6f} m between the centres", *second,
                             contact.distance_m)
               : fmt::format("touches an obstacle, as vision shows: its centre is {:.6f} m from the edge",
                             contact.distance_m));
  }
}

void VisionAudit::record_positions(const msg::WorldState& world) {
  std::vector<AuditedRobot>& robots = robots_.all();
  excuses_.begin_observation();
  for (const msg::TrackedRobot& tracked : world.robots()) {
    const auto index = robots_.index_of(tracked.robot());
    if (!index || !is_sane(tracked)) continue;
    AuditedRobot& robot = robots[*index];
    const VisionSighting& sight = sightings_[*index];
    if (sight.is_new)
      robot.observation = {sight.observed_at_ns, sight.position_m.x(), sight.position_m.y(), 0};
    const double error_m = robot.distance_from_version_m(sight.position_m, sight.observed_at_ns);
    excuses_.observe(robot, {tracked.x_m(), tracked.y_m()}, sight.velocity_mps.norm(), error_m,
                     run_.observation_allowance_m());
  }
  for (std::size_t i = 0; i < robots.size(); ++i) {
    // Vision does not see a robot that is not on the floor.
    const bool is_lifted = robots[i].last_report && robots[i].last_report->is_lifted;
    if (is_lifted || sightings_[i].is_new)
      coverage_.hear_reference(i, is_lifted ? Duration{0} : Duration::max());
  }
}

}  // namespace sidestep
