// SPDX-License-Identifier: Apache-2.0
#include "common/robot/conversion.hpp"

namespace sidestep {
namespace {

static_assert(robot::Version::kMaxPhases == Trajectory::kMaxPhases);

// The wire format uses float, so no precision is lost.
robot::Intent to_plain(const Intent& intent) {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  return {narrow(intent.velocity_mps.x()),    narrow(intent.velocity_mps.y()),
          narrow(intent.velocity_duration_s), narrow(intent.waypoint_m.x()),
          narrow(intent.waypoint_m.y()),      narrow(intent.goal_m.x()),
          narrow(intent.goal_m.y()),          narrow(intent.target_m.x()),
          narrow(intent.target_m.y()),        to_ns(intent.due)};
}

Intent from_plain(const robot::Intent& intent) {
  return {{intent.vx_mps, intent.vy_mps},
          intent.velocity_duration_s,
          {intent.waypoint_x_m, intent.waypoint_y_m},
          {intent.goal_x_m, intent.goal_y_m},
          {intent.target_x_m, intent.target_y_m},
          time_from_ns(intent.due_ns)};
}

}  // namespace

robot::Version to_plain(const Version& version) {
  const Trajectory& trajectory = version.trajectory;
  robot::Version plain;
  plain.incarnation = version.incarnation;
  plain.number = version.number;
  plain.base = version.base;
  plain.start_ns = to_ns(trajectory.start());
  plain.x_m = trajectory.at_start().position_m.x();
  plain.y_m = trajectory.at_start().position_m.y();
  plain.vx_mps = trajectory.at_start().velocity_mps.x();
  plain.vy_mps = trajectory.at_start().velocity_mps.y();
  plain.inflation_m = version.inflation_m;
  plain.has_intent = version.intent.has_value();
  if (version.intent) plain.intent = to_plain(*version.intent);
  for (const MotionPhase& phase : trajectory.phases())
    plain.phases[plain.phase_count++] = {phase.duration.count(), phase.acceleration_mps2.x(),
                                         phase.acceleration_mps2.y()};
  return plain;
}

Version from_plain(const robot::Version& plain, RobotId robot) {
  Version version;
  version.robot = robot;
  version.incarnation = plain.incarnation;
  version.number = plain.number;
  version.base = plain.base;
  version.trajectory =
      Trajectory(time_from_ns(plain.start_ns), {{plain.x_m, plain.y_m}, {plain.vx_mps, plain.vy_mps}});
  for (int i = 0; i < plain.phase_count; ++i)
    version.trajectory.append(Duration{plain.phases[i].duration_ns},
                              {plain.phases[i].ax_mps2, plain.phases[i].ay_mps2});
  version.inflation_m = plain.inflation_m;
  if (plain.has_intent) version.intent = from_plain(plain.intent);
  return version;
}

RobotReport from_plain(const robot::RobotReport& plain, RobotId robot) {
  RobotReport robot_report;
  robot_report.robot = robot;
  robot_report.obeyed_incarnation = plain.obeyed_incarnation;
  robot_report.obeyed_epoch = plain.obeyed_epoch;
  robot_report.valid_at = time_from_ns(plain.valid_at_ns);
  robot_report.executing = from_plain(*plain.executing, robot);
  robot_report.is_off_reference = plain.is_off_reference;
  robot_report.is_lifted = plain.is_lifted;
  if (plain.has_command)
    robot_report.command = {time_from_ns(plain.command_sent_at_ns),
                            time_from_ns(plain.command_received_at_ns)};
  robot_report.has_moved = plain.has_moved;
  robot_report.activated = plain.activated;
  robot_report.lead = Duration{plain.lead_ns};
  return robot_report;
}

}  // namespace sidestep
