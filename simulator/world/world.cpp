// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/world.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

// Odometry noise of wheels slower than this is reduced in proportion to their speed.
constexpr double kFullNoiseSpeed_mps = 0.1;

/// Capabilities of wheels and floor that suffice for the robots' limits, with a reserve to follow the
/// reference.
BodySettings body_settings(const MotionLimits& limits) {
  BodySettings body;
  const double needed_mps2 = 1.2 * std::max(limits.acceleration_mps2, limits.deceleration_mps2);
  body.acceleration_mps2 = std::max(body.acceleration_mps2, needed_mps2);
  body.friction_mps2 = std::max(body.friction_mps2, needed_mps2);
  body.speed_mps = std::max(body.speed_mps, 1.25 * limits.speed_mps);
  return body;
}

FirmwareSettings firmware_settings(const Scenario& scenario) {
  FirmwareSettings settings;
  settings.body = body_settings(scenario.limits);
  settings.estimator.velocity_noise_mps = scenario.odometry.velocity_noise_mps;
  settings.estimator.scale_error = scenario.odometry.scale_error;
  settings.estimator.fix_noise_m = scenario.vision.position_noise_m;
  settings.tracking_bound_m = scenario.tracking_bound_m;
  settings.deceleration_mps2 = scenario.limits.deceleration_mps2;
  return settings;
}

// Approximately standard normal, from one random number: the sum of four uniform ones (Irwin-Hall
// distribution). Integrating the odometry hides the shape of its distribution, and this takes a tenth of
// Rng::normal()'s time.
double approximately_normal(Rng& rng) {
  const std::uint64_t bits = rng.bits();
  const std::uint64_t sum = (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
  return (static_cast<double>(sum) - 2 * 65535.0) * (1.7320508075688772 / 65536);
}

}  // namespace

World::World(const Scenario& scenario, Time begin, std::uint64_t seed)
    : field_(scenario.field),
      obstacles_(scenario.obstacles),
      map_(scenario.map),
      radius_m_(scenario.radius_m),
      velocity_noise_mps_(scenario.odometry.velocity_noise_mps),
      clock_bound_(from_seconds(scenario.clock_bound_s)),
      tracking_bound_m_(scenario.tracking_bound_m),
      time_(begin),
      contacts_(scenario.obstacles, scenario.map, scenario.radius_m,
                body_settings(scenario.limits).speed_mps),
      opponents_(scenario.opponents, scenario.radius_m, body_settings(scenario.limits).speed_mps) {
  Rng rng(seed);
  const FirmwareSettings settings = firmware_settings(scenario);
  bodies_.reserve(scenario.robots.size());
  vision_faults_.resize(scenario.robots.size());
  robots_.reserve(scenario.robots.size());
  pending_reports_.reserve(scenario.robots.size());
  for (const RobotSpec& spec : scenario.robots) {
    bodies_.emplace_back(spec.start_m, spec.start_heading_rad, settings.body);
    const ClockError clock_error{spec.clock_offset, spec.clock_drift_ppm, begin};
    const Time clock = clock_error.reading(begin);
    Firmware firmware(spec.id, spec.start_m, spec.start_heading_rad, clock, settings);
    const FirmwareMonitor monitor(firmware.executing(), settings.tracking_bound_m,
                                  settings.deceleration_mps2);
    Rng noise = rng.fork();
    const double scale = 1 + scenario.odometry.scale_error * noise.normal();
    robots_.push_back({spec.id,
                       std::move(firmware),
                       monitor,
                       noise,
                       scale,
                       {},
                       spec.start_m,
                       spec.start_heading_rad,
                       clock_error,
                       clock});
    if (spec.is_absent) lift(robots_.size() - 1, begin);
  }
  if (scenario.ball) ball_.emplace(State{scenario.ball->position_m, scenario.ball->velocity_mps});
}

void World::advance(Time to) {
  while (to - time_ >= kPhysicsStep) step();
}

void World::step() {
  time_ += kPhysicsStep;
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].step(robots_[i].actuation);
  contacts_.step(bodies_);
  if (!opponents_.empty()) opponents_.step(bodies_);
  if (ball_) ball_->step(field_, obstacles_, map_.get(), bodies_, radius_m_);
  if (!active_disturbances_.empty()) end_disturbances();
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    const Time now = robot_time(i, time_);
    if (!robot.is_powered) continue;
    switch_versions(i, now);
    robot.actuation = robot.firmware.tick(now, measure(i));
    if (!robot.firmware.has_pose()) record_disturbance(i, time_);
    if (robot.firmware.is_off_reference() && robot.firmware.executing().number != robot.last_own_stop) {
      robot.last_own_stop = robot.firmware.executing().number;
      robot.monitor.started_own_stop(robot.firmware.executing());
      request_report(i);
    }
  }
}

// Reads a robot's clock. A clock that is set back by less than the bound stops until the new time has caught
// up with it, so that reported facts stay true. If it is set back farther, the robot begins a new
// incarnation, and earlier facts are void.
Time World::robot_time(std::size_t index, Time now) {
  Robot& robot = robots_[index];
  // A scan or a command may request an earlier time than the request before it.
  robot.read_at = std::max(robot.read_at, now);
  const Time reading = robot.clock_error.reading(robot.read_at);
  if (robot.clock - reading <= clock_bound_) return robot.clock = std::max(robot.clock, reading);
  robot.firmware.set_clock_back(robot.clock, reading);
  robot.monitor.clock_went_back();
  ++robot.clock_setbacks;
  return robot.clock = reading;
}

void World::on_host_clock_set_back(Duration by) {
  host_setback_ += by;
  for (Robot& robot : robots_) robot.clock_error.offset -= by;
}

Time World::next_start(std::size_t index) const {
  const Time start = robots_[index].firmware.next_start();
  return !robots_[index].is_powered || start == Time::max() ? Time::max()
                                                            : robots_[index].clock_error.true_time(start);
}

Odometry World::measure(std::size_t index) {
  Robot& robot = robots_[index];
  const Body& body = bodies_[index];
  const Vec2 rolled_position = body.rolled_position_m();
  const Vec2 velocity = (rolled_position - robot.last_position_m) / kPhysicsStepSeconds;
  const double angular = (body.heading_rad() - robot.last_heading_rad) / kPhysicsStepSeconds;
  robot.last_position_m = rolled_position;
  robot.last_heading_rad = body.heading_rad();
  // Wheels that stand still generate no pulses.
  const double wheel_speed_mps = velocity.norm() + radius_m_ * std::abs(angular);
  const double noise_mps = velocity_noise_mps_ * std::min(1.0, wheel_speed_mps / kFullNoiseSpeed_mps);
  const double x_noise = noise_mps * approximately_normal(robot.noise);
  const double y_noise = noise_mps * approximately_normal(robot.noise);
  // The wheels are at the rim, where this angular noise equals the velocity noise.
  const double angular_noise = noise_mps / radius_m_ * approximately_normal(robot.noise);
  return {robot.odometry_scale * velocity + Vec2(x_noise, y_noise),
          robot.odometry_scale * angular + angular_noise};
}

void World::switch_versions(std::size_t index, Time now) {
  Robot& robot = robots_[index];
  if (robot.firmware.next_start() > now) return;
  while (robot.firmware.switch_next(now)) {
    robot.monitor.switched(robot.firmware.executing());
    request_report(index);
  }
}

void World::request_report(std::size_t index) {
  if (robots_[index].has_pending_report) return;
  robots_[index].has_pending_report = true;
  pending_reports_.push_back(static_cast<std::uint32_t>(index));
}

void World::clear_pending_report(std::size_t index) {
  if (!robots_[index].has_pending_report) return;
  robots_[index].has_pending_report = false;
  std::erase(pending_reports_, static_cast<std::uint32_t>(index));
}

void World::on_command(std::size_t index, const Command& command, Time now) {
  Robot& robot = robots_[index];
  if (!robot.is_powered) return;
  const Time clock = robot_time(index, now);
  switch_versions(index, clock);
  robot.monitor.command_arrived(command, clock);
  const Incarnation obeyed = robot.firmware.obeyed_incarnation();
  const Epoch epoch = robot.firmware.obeyed_epoch();
  robot.firmware.on_command(command, clock);
  if (robot.firmware.obeyed_incarnation() != obeyed || robot.firmware.obeyed_epoch() != epoch)
    request_report(index);
}

void World::on_malformed_command(std::size_t index, Time now) {
  if (!robots_[index].is_powered) return;
  const Time clock = robot_time(index, now);
  switch_versions(index, clock);
  robots_[index].firmware.on_malformed_command(clock);
}

RobotReport World::robot_report(std::size_t index, Time now) {
  const Time clock = robot_time(index, now);
  switch_versions(index, clock);
  RobotReport robot_report = robots_[index].firmware.robot_report(clock);
  robot_report.robot_incarnation = robots_[index].clock_setbacks;
  robots_[index].monitor.reported(robot_report);
  return robot_report;
}

std::uint64_t World::firmware_violations() const {
  std::uint64_t sum = 0;
  for (const Robot& robot : robots_) sum += robot.monitor.violations();
  return sum;
}

void World::count_drops(DropCounters& drops) const {
  for (const Robot& robot : robots_) {
    const robot::Counts& counts = robot.firmware.counts();
    drops.count(DropReason::kMalformedCommand, robot.id, counts.refused_malformed);
    drops.count(DropReason::kFencedCommand, robot.id, counts.refused_fenced);
    drops.count(DropReason::kLateVersion, robot.id, counts.refused_late);
    drops.count(DropReason::kWrongBase, robot.id, counts.refused_base);
  }
}

double World::reference_error_m(std::size_t index) const {
  const Robot& robot = robots_[index];
  if (robot.firmware.is_lifted()) return 0;
  const Time now = std::max(robot.clock, robot.clock_error.reading(time_));
  const State reference = robot.firmware.executing().trajectory.state_at(now);
  return (bodies_[index].position_m() - reference.position_m).norm();
}

void World::fill(msg::GroundTruth& truth) const {
  truth.valid_at_ns(to_ns(host_time(time_)));
  truth.contacts(contacts().contacts);
  for (std::size_t i = 0; i < std::min<std::size_t>(contacts().contacts, msg::MAX_CONTACTS); ++i) {
    const ContactPair& contact = contacts().recent_contacts[i];
    truth.recent_contacts()[i].first(robots_[contact.first].id);
    truth.recent_contacts()[i].second(contact.second < robots_.size() ? robots_[contact.second].id
                                                                      : msg::NO_ROBOT);
  }
  truth.penetration_m_s(contacts().penetration_m_s);
  truth.min_clearance_m(contacts().min_clearance_m);
  truth.firmware_violations(firmware_violations());
  const CrashTotals& crashes = opponents_.totals();
  truth.crashes(crashes.crashes);
  truth.crashes_while_moving(crashes.crashes_while_moving);
  for (std::size_t i = 0; i < std::min<std::size_t>(crashes.crashes_while_moving, msg::MAX_CONTACTS); ++i)
    truth.recent_moving_crashes()[i] = robots_[crashes.recent_moving_crashes[i]].id;
  truth.max_crash_speed_mps(crashes.max_crash_speed_mps);
  truth.max_robot_crash_speed_mps(crashes.max_robot_crash_speed_mps);
  const Vec2 ball = ball_ ? ball_->state().position_m : Vec2(0, 0);
  truth.ball_x_m(ball.x());
  truth.ball_y_m(ball.y());
  std::size_t count = 0;
  truth.robots().resize(robots_.size());
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    if (!bodies_[i].is_on_floor()) continue;
    msg::TrueRobotState& robot = truth.robots()[count++];
    robot.robot(robots_[i].id);
    robot.x_m(bodies_[i].position_m().x());
    robot.y_m(bodies_[i].position_m().y());
    robot.heading_rad(wrapped_rad(bodies_[i].heading_rad()));
    robot.vx_mps(bodies_[i].velocity_mps().x());
    robot.vy_mps(bodies_[i].velocity_mps().y());
    robot.reference_error_m(reference_error_m(i));
    const std::optional<Time> end = disturbance_end(i);
    robot.disturbance_end_ns(end ? to_ns(host_time(*end)) : -1);
  }
  truth.robots().resize(count);
}

}  // namespace sidestep
