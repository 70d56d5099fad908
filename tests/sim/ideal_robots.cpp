// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/ideal_robots.hpp"

#include <algorithm>
#include <limits>

#include "common/messaging/robot_codec.hpp"
#include "common/protocol/obstacle_bounds.hpp"
#include "common/protocol/senders.hpp"
#include "tests/sim/disturbance.hpp"

namespace sidestep {
namespace {

// Distance of an own stop's number from the highest number seen. Agents do not count this far in a year.
constexpr VersionNumber kOwnNumberGap = VersionNumber{1} << 32;

Vec2 rounded(const Vec2& v) { return v.cast<float>().cast<double>(); }

Version rounded(const Version& version) {
  Version result = version;
  const State& start = version.trajectory.at_start();
  result.trajectory =
      Trajectory(version.trajectory.start(), {rounded(start.position_m), rounded(start.velocity_mps)});
  for (const MotionPhase& phase : version.trajectory.phases())
    result.trajectory.append(phase.duration, rounded(phase.acceleration_mps2));
  return result;
}

}  // namespace

IdealRobots::IdealRobots(Bus& bus, const Scenario& scenario)
    : bus_(bus),
      radius_m_(scenario.radius_m),
      deceleration_mps2_(scenario.limits.deceleration_mps2),
      cycle_(scenario.cycle) {
  for (const RobotSpec& spec : scenario.robots) {
    Robot& robot = robots_[spec.id];
    robot.id = spec.id;
    robot.executing = {spec.id, 0, 0, 0, Trajectory::resting(time_from_ns(0), spec.start_m)};
    robot.is_lifted = spec.is_absent;
    robot.writer = bus.advertise(topics::kFeedback, spec.id);
    bus.subscribe(topics::kCommand, spec.id, [this, &robot](const msg::Command& message) {
      if (const auto command = decode(message, robot.id, bus_.now() + robot.clock_offset))
        on_command(robot, *command);
    });
    report_periodically(robot);
  }
  world_writer_ = bus.advertise(topics::kWorld);
  obstacle_writer_ = bus.advertise(topics::kObstacles);
  disturbance_writer_ = bus.advertise(topics::kDisturbance);
  publish_world();
}

void IdealRobots::push(RobotId id, const Vec2& shift, const Vec2& velocity, double inflation_m) {
  const Time now = bus_.now();
  Robot& robot = robots_.at(id);
  advance(robot, now);
  if (robot.is_lifted) return;
  robot.highest += kOwnNumberGap;
  Trajectory stop(now, {robot.executing.trajectory.state_at(now).position_m + shift, velocity});
  append_stop(stop, deceleration_mps2_);
  robot.executing = {id, robot.obeyed, robot.highest, robot.executing.number, stop, inflation_m};
  robot.pending.clear();
  robot.is_off_reference = true;
  report(robot);
}

void IdealRobots::lift(RobotId id) {
  const Time now = bus_.now();
  Robot& robot = robots_.at(id);
  advance(robot, now);
  robot.executing = {id, 0, 0, 0,
                     Trajectory::resting(now, robot.executing.trajectory.state_at(now).position_m)};
  robot.pending.clear();
  robot.is_lifted = true;
  robot.is_off_reference = false;
  report(robot);
}

void IdealRobots::place(RobotId id, const Vec2& position) {
  auto placed = disturbance(id, msg::DisturbanceKind::DISTURBANCE_PLACE);
  placed.x_m(position.x());
  placed.y_m(position.y());
  disturbance_writer_.publish(placed, bus_.now());
}

void IdealRobots::publish_world() {
  const Time now = bus_.now();
  bus_.at(now + cycle_, [this] { publish_world(); });
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  world.valid_at_ns(to_ns(now));
  for (const auto& [id, robot] : robots_) {
    if (robot.is_lifted) continue;
    const Vec2 position = position_m(id, now);
    msg::TrackedRobot& tracked = world.robots().emplace_back();
    tracked.robot(id);
    tracked.observed_at_ns(to_ns(now));
    tracked.observed_x_m(position.x());
    tracked.observed_y_m(position.y());
  }
  world_writer_.publish(world, now);
  msg::ObstacleList no_obstacles;
  no_obstacles.header() = world.header();
  no_obstacles.valid_at_ns(world.valid_at_ns());
  no_obstacles.complete_within_m(kCompleteEverywhere_m);
  obstacle_writer_.publish(no_obstacles, now);
}

void IdealRobots::on_command(Robot& robot, const Command& command) {
  const Time now = bus_.now() + robot.clock_offset;
  advance(robot, now);
  if (command.incarnation < robot.obeyed) return;
  robot.last_command = {command.sent_at, now};
  robot.highest = std::max<VersionNumber>(robot.highest, command.incarnation);
  const bool has_new_fence = command.incarnation > robot.obeyed || command.epoch > robot.obeyed_epoch;
  if (command.incarnation > robot.obeyed) {
    robot.obeyed = command.incarnation;
    std::erase_if(robot.pending, [&](const Version& v) { return v.incarnation < robot.obeyed; });
  }
  const bool is_old_epoch = command.epoch < robot.obeyed_epoch;
  robot.obeyed_epoch = std::max(robot.obeyed_epoch, command.epoch);
  if (has_new_fence) report(robot);
  if (!command.version || is_old_epoch) return;
  const Version& version = *command.version;
  robot.highest = std::max(robot.highest, version.number);
  const auto is_same = [&](const Version& held) { return held.number == version.number; };
  if (version.trajectory.start() <= now || std::ranges::any_of(robot.pending, is_same)) return;
  robot.pending.push_back(robot.rounds_versions ? rounded(version) : version);
  std::ranges::sort(robot.pending, {}, [](const Version& v) { return v.trajectory.start(); });
  bus_.at(version.trajectory.start() - robot.clock_offset, [this, &robot] { report(robot); });
}

void IdealRobots::advance(Robot& robot, Time now) {
  while (!robot.pending.empty() && robot.pending.front().trajectory.start() <= now) {
    const Version& due = robot.pending.front();
    const bool is_rest_version = due.base == 0 && due.trajectory.phases().empty();
    if (due.base == robot.executing.number && due.number > robot.executing.number &&
        (!robot.is_lifted || is_rest_version)) {
      robot.executing = robot.pending.front();
      robot.has_moved = true;
      robot.is_off_reference = robot.is_lifted = false;  // a lifted robot has now been put down
    }
    robot.pending.erase(robot.pending.begin());
  }
}

void IdealRobots::report(Robot& robot) {
  const Time now = bus_.now() + robot.clock_offset;
  advance(robot, now);
  RobotReport robot_report;
  robot_report.robot = robot.id;
  robot_report.obeyed_incarnation = robot.obeyed;
  robot_report.obeyed_epoch = robot.obeyed_epoch;
  robot_report.valid_at = now;
  robot_report.command = robot.last_command;
  robot_report.executing = robot.executing;
  robot_report.is_off_reference = robot.is_off_reference;
  robot_report.is_lifted = robot.is_lifted;
  robot_report.has_moved = robot.has_moved;
  robot_report.estimate = robot.executing.trajectory.state_at(now);
  msg::Feedback message = encode(robot_report);
  robot.writer.publish(message, bus_.now());
}

void IdealRobots::report_periodically(Robot& robot) {
  bus_.at(bus_.now() + 2 * cycle_, [this, &robot] { report_periodically(robot); });
  report(robot);
}

State IdealRobots::state_at(RobotId id, Time t) {
  Robot& robot = robots_.at(id);
  advance(robot, t + robot.clock_offset);
  return robot.executing.trajectory.state_at(t + robot.clock_offset);
}

const Version& IdealRobots::executing(RobotId id, Time t) {
  Robot& robot = robots_.at(id);
  advance(robot, t + robot.clock_offset);
  return robot.executing;
}

double IdealRobots::clearance_m(Time t) {
  std::vector<Vec2> positions;
  for (const auto& [id, robot] : robots_) {
    if (!robot.is_lifted) positions.push_back(position_m(id, t));
  }
  double min_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      min_distance = std::min(min_distance, (positions[i] - positions[j]).norm());
  }
  return min_distance - 2 * radius_m_;
}

}  // namespace sidestep
