// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "simulator/world/world.hpp"

namespace sidestep {
namespace {

// A robot is put down at its rest version if that is within this distance of the requested place.
constexpr double kPlaceTolerance_m = 0.005;

}  // namespace

bool World::disturb(std::size_t index, const RobotDisturbance& disturbance, Time now) {
  if (check_disturbance(index, disturbance) != msg::DisturbanceResult::FAULT_APPLIED) return false;
  Robot& robot = robots_[index];
  Body& body = bodies_[index];
  const auto kind = disturbance.kind;
  switch (kind) {
    case msg::DisturbanceKind::DISTURBANCE_PUSH:
      body.push(disturbance.push_mps);
      record_disturbance(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_SLIP:
      body.set_grip(disturbance.grip);
      start_disturbance({index, kind, now + disturbance.duration, Vec2(0, 0), 0});
      record_disturbance(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_BLOCK:
      body.set_blocked_wheel(disturbance.heading_rad);
      start_disturbance({index, kind, now + disturbance.duration, Vec2(0, 0), 0});
      record_disturbance(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_LIFT:
      lift(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_PLACE:
      start_disturbance({index, kind, Time::max(), disturbance.place_m, disturbance.heading_rad});
      return true;
    case msg::DisturbanceKind::DISTURBANCE_REBOOT:
      if (!body.is_on_floor()) {
        lift(index, now);
      } else {
        robot.firmware.reboot();
        robot.monitor.rebooted();
      }
      record_disturbance(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_FORGET_POSE:
      switch_versions(index, robot_time(index, now));
      robot.firmware.forget_pose(robot_time(index, now));
      robot.monitor.rebooted();
      record_disturbance(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_CLOCK:
      set_clock(index, disturbance.clock_offset, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF:
      switch_off(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_ON:
      switch_on(index, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_CARRY:
      carry(index, disturbance, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE:
      start_seen_beside(index, disturbance, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_SEEN_AS:
      start_seen_as(index, disturbance, now);
      return true;
    case msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN:
      start_seen_frozen(index, disturbance, now);
      return true;
  }
  return false;
}

void World::lift(std::size_t index, Time now) {
  cancel_disturbances(index, msg::DisturbanceKind::DISTURBANCE_PLACE);
  cancel_disturbances(index, msg::DisturbanceKind::DISTURBANCE_CARRY);
  const Time clock = robot_time(index, now);
  switch_versions(index, clock);
  bodies_[index].lift();
  robots_[index].firmware.lift(clock);
  robots_[index].monitor.lifted();
  robots_[index].actuation = {};
  contacts_.invalidate_near_pairs();
  opponents_.invalidate_near_pairs();
  record_disturbance(index, now);
  request_report(index);
}

void World::switch_off(std::size_t index, Time now) {
  switch_versions(index, robot_time(index, now));
  robots_[index].is_powered = false;
  robots_[index].actuation = {};
  bodies_[index].set_powered(false);
  record_disturbance(index, now);
}

void World::switch_on(std::size_t index, Time now) {
  Robot& robot = robots_[index];
  robot.is_powered = true;
  bodies_[index].set_powered(true);
  // Odometry does not measure how far the wheels have rolled without power.
  robot.last_position_m = bodies_[index].rolled_position_m();
  robot.last_heading_rad = bodies_[index].heading_rad();
  robot.firmware.switch_on(robot_time(index, now));
  if (!robot.firmware.is_lifted()) robot.monitor.rebooted();
  record_disturbance(index, now);
  request_report(index);
}

// Sets a robot's clock. A jump beyond the bound displaces a reference that is moving or about to move.
void World::set_clock(std::size_t index, Duration offset, Time now) {
  Robot& robot = robots_[index];
  const Time before = robot_time(index, now);
  switch_versions(index, before);
  robot.clock_error = {offset - host_setback_, robot.clock_error.drift_ppm, now};
  const bool moves = robot.firmware.executing().trajectory.end() > before;
  if (robot.is_powered && (moves || robot.firmware.next_start() != Time::max()) &&
      std::chrono::abs(robot.clock_error.reading(now) - before) > clock_bound_)
    record_disturbance(index, now);
}

void World::carry(std::size_t index, const RobotDisturbance& disturbance, Time now) {
  const Vec2 path_m = disturbance.place_m - bodies_[index].position_m();
  bodies_[index].carry(Vec2(path_m / to_seconds(disturbance.duration)));
  start_disturbance({index, disturbance.kind, now + disturbance.duration, disturbance.place_m, 0});
  record_disturbance(index, now);
}

void World::start_seen_beside(std::size_t index, const RobotDisturbance& disturbance, Time now) {
  vision_faults_[index].offset_m = disturbance.place_m;
  start_disturbance({index, disturbance.kind, now + disturbance.duration, disturbance.place_m, 0});
}

void World::start_seen_as(std::size_t index, const RobotDisturbance& disturbance, Time now) {
  const std::size_t other_index = confusable_with(index, disturbance).value();
  vision_faults_[index].shown_as = other_index;
  vision_faults_[other_index].shown_as = index;
  for (const std::size_t confused : {index, other_index})
    start_disturbance({confused, disturbance.kind, now + disturbance.duration, Vec2(0, 0), 0});
}

void World::start_seen_frozen(std::size_t index, const RobotDisturbance& disturbance, Time now) {
  vision_faults_[index].frozen = {bodies_[index].position_m(), bodies_[index].heading_rad()};
  start_disturbance({index, disturbance.kind, now + disturbance.duration, Vec2(0, 0), 0});
}

// A robot follows the position that cameras show, so a wrong position displaces the body. An error within the
// bound for vision errors is part of the robot's tracking error.
bool World::affects_body(const ActiveDisturbance& disturbance) const {
  if (disturbance.kind == msg::DisturbanceKind::DISTURBANCE_PLACE) return false;
  return disturbance.kind != msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE ||
         disturbance.place_m.norm() > vision_error_bound_m(tracking_bound_m_);
}

void World::record_disturbance(std::size_t index, Time at) {
  std::optional<Time>& last = robots_[index].last_disturbance;
  last = std::max(last.value_or(at), at);
}

std::optional<Time> World::disturbance_end(std::size_t index) const {
  std::optional<Time> last = robots_[index].last_disturbance;
  for (const ActiveDisturbance& active : active_disturbances_) {
    if (active.robot == index && affects_body(active)) last = std::max(last.value_or(active.end), active.end);
  }
  return last;
}

void World::start_disturbance(const ActiveDisturbance& disturbance) {
  cancel_disturbances(disturbance.robot, disturbance.kind);
  active_disturbances_.push_back(disturbance);
}

void World::cancel_disturbances(std::size_t robot, msg::DisturbanceKind kind) {
  std::erase_if(active_disturbances_, [&](const ActiveDisturbance& active) {
    return active.robot == robot && active.kind == kind;
  });
}

void World::end_disturbances() {
  std::erase_if(active_disturbances_, [this](ActiveDisturbance& active) {
    if (active.kind == msg::DisturbanceKind::DISTURBANCE_PLACE) return try_put_down(active);
    if (active.end > time_) return false;
    if (affects_body(active)) record_disturbance(active.robot, active.end);
    end(active);
    if (!is_misled_by_cameras(active)) return true;
    active.end = time_ + kPhysicsStep;
    return false;
  });
}

bool World::is_misled_by_cameras(const ActiveDisturbance& disturbance) const {
  const Robot& robot = robots_[disturbance.robot];
  const Body& body = bodies_[disturbance.robot];
  const bool has_misled = disturbance.kind == msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE ||
                          disturbance.kind == msg::DisturbanceKind::DISTURBANCE_SEEN_AS ||
                          disturbance.kind == msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN;
  return has_misled && affects_body(disturbance) && robot.is_powered && body.is_on_floor() &&
         (robot.firmware.position_m() - body.position_m()).norm() > vision_error_bound_m(tracking_bound_m_);
}

void World::end(const ActiveDisturbance& disturbance) {
  Body& body = bodies_[disturbance.robot];
  VisionFault& vision_fault = vision_faults_[disturbance.robot];
  switch (disturbance.kind) {
    case msg::DisturbanceKind::DISTURBANCE_SLIP:
      return body.set_grip(1);
    case msg::DisturbanceKind::DISTURBANCE_BLOCK:
      return body.set_blocked_wheel(std::nullopt);
    case msg::DisturbanceKind::DISTURBANCE_CARRY:
      return body.carry(std::nullopt);
    case msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE:
      vision_fault.offset_m = Vec2(0, 0);
      return;
    case msg::DisturbanceKind::DISTURBANCE_SEEN_AS:
      return vision_fault.shown_as.reset();
    case msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN:
      return vision_fault.frozen.reset();
    default:
      return;
  }
}

bool World::try_put_down(const ActiveDisturbance& request) {
  Robot& robot = robots_[request.robot];
  const Version& rest_version = robot.firmware.executing();
  const Vec2 place_m = rest_version.trajectory.rest_position_m();
  if (rest_version.number == 0 || (place_m - request.place_m).norm() > kPlaceTolerance_m) return false;
  bodies_[request.robot].put_down(place_m, request.heading_rad);
  robot.firmware.put_down(request.heading_rad, robot_time(request.robot, time_));
  robot.monitor.put_down();
  record_disturbance(request.robot, time_);
  robot.last_position_m = bodies_[request.robot].rolled_position_m();
  robot.last_heading_rad = request.heading_rad;
  contacts_.invalidate_near_pairs();
  opponents_.invalidate_near_pairs();
  request_report(request.robot);
  return true;
}

}  // namespace sidestep
