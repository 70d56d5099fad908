// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/robot_codec.hpp"

#include <cmath>

#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

// A robot that needs a longer lead cannot be driven.
constexpr Duration kMaxLead = std::chrono::milliseconds(300);

bool is_magnitude(double value) { return std::isfinite(value) && value >= 0; }

std::optional<PoseFix> decode(const msg::PoseFix& message) {
  const PoseFix fix{
      time_from_ns(message.captured_at_ns()), {message.x_m(), message.y_m()}, message.heading_rad()};
  // The comparisons are false for NaN.
  const bool is_valid = std::abs(fix.position_m.x()) <= kMaxCoordinate_m &&
                        std::abs(fix.position_m.y()) <= kMaxCoordinate_m && std::isfinite(fix.heading_rad);
  return is_valid ? std::optional(fix) : std::nullopt;
}

msg::PoseFix encode(const PoseFix& fix) {
  msg::PoseFix message;
  message.captured_at_ns(to_ns(fix.captured_at));
  message.x_m(fix.position_m.x());
  message.y_m(fix.position_m.y());
  message.heading_rad(fix.heading_rad);
  return message;
}

}  // namespace

std::optional<Command> decode(const msg::Command& message, RobotId robot, Time now) {
  const msg::Header& header = message.header();
  const bool is_valid = message.robot() == robot && header.sender() == robot && header.incarnation() > 0 &&
                        is_plausible(header.incarnation(), now) && is_plausible(message.epoch(), now) &&
                        is_plausible(time_from_ns(header.stamp_ns()), now) &&
                        std::isfinite(message.desired_heading_rad());
  if (!is_valid) return std::nullopt;
  Command command{robot, header.incarnation(), message.epoch(), time_from_ns(header.stamp_ns())};
  command.desired_heading_rad = message.desired_heading_rad();
  if (message.has_fix()) {
    command.fix = decode(message.fix());
    if (!command.fix) return std::nullopt;
  }
  if (message.has_version()) {
    command.version = decode(message.version(), now);
    const bool is_valid_version = command.version && command.version->robot == robot &&
                                  command.version->number > 0 &&
                                  command.version->incarnation <= command.incarnation;
    if (!is_valid_version) return std::nullopt;
  }
  return command;
}

std::optional<RobotReport> decode(const msg::Feedback& message, RobotId robot, Time now) {
  const State estimate{{message.x_m(), message.y_m()}, {message.vx_mps(), message.vy_mps()}};
  const LocalisationUncertainty uncertainty{message.position_error_rms_m(), message.odometry_scale_stddev()};
  const bool is_valid =
      message.robot() == robot && message.header().sender() == robot &&
      is_plausible(message.header().incarnation(), now) && is_plausible(message.obeyed_incarnation(), now) &&
      is_plausible(message.obeyed_epoch(), now) && is_plausible(time_from_ns(message.valid_at_ns()), now) &&
      is_plausible(time_from_ns(message.command_stamp_ns()), now) &&
      is_plausible(time_from_ns(message.command_received_at_ns()), now) && estimate.position_m.allFinite() &&
      estimate.velocity_mps.allFinite() && std::isfinite(message.heading_rad()) &&
      is_magnitude(message.tracking_error_m()) && is_magnitude(uncertainty.position_error_rms_m) &&
      is_magnitude(uncertainty.odometry_scale_stddev) && message.lead_ns() >= 0 &&
      message.lead_ns() <= kMaxLead.count();
  if (!is_valid) return std::nullopt;
  auto executing = decode(message.executing(), now);
  if (!executing || executing->robot != robot) return std::nullopt;
  RobotReport robot_report;
  robot_report.robot = robot;
  robot_report.robot_incarnation = message.header().incarnation();
  robot_report.obeyed_incarnation = message.obeyed_incarnation();
  robot_report.obeyed_epoch = message.obeyed_epoch();
  robot_report.valid_at = time_from_ns(message.valid_at_ns());
  robot_report.executing = *executing;
  robot_report.is_off_reference = message.is_off_reference();
  robot_report.is_lifted = message.is_lifted();
  if (message.command_stamp_ns() != 0) {
    robot_report.command = {time_from_ns(message.command_stamp_ns()),
                            time_from_ns(message.command_received_at_ns())};
  }
  robot_report.estimate = estimate;
  robot_report.heading_rad = message.heading_rad();
  robot_report.tracking_error_m = message.tracking_error_m();
  robot_report.uncertainty = uncertainty;
  robot_report.has_moved = message.has_moved();
  robot_report.activated = message.activated();
  robot_report.lead = Duration{message.lead_ns()};
  return robot_report;
}

msg::Command encode(const Command& command) {
  msg::Command message;
  message.robot(command.robot);
  message.header().sender(command.robot);
  message.header().incarnation(command.incarnation);
  message.epoch(command.epoch);
  message.has_version(command.version.has_value());
  if (command.version) message.version(encode(*command.version));
  message.has_fix(command.fix.has_value());
  if (command.fix) message.fix(encode(*command.fix));
  message.desired_heading_rad(command.desired_heading_rad);
  return message;
}

msg::Feedback encode(const RobotReport& robot_report) {
  msg::Feedback message;
  message.robot(robot_report.robot);
  message.header().sender(robot_report.robot);
  message.header().incarnation(robot_report.robot_incarnation);
  message.obeyed_incarnation(robot_report.obeyed_incarnation);
  message.obeyed_epoch(robot_report.obeyed_epoch);
  message.valid_at_ns(to_ns(robot_report.valid_at));
  message.executing(encode(robot_report.executing));
  message.is_off_reference(robot_report.is_off_reference);
  message.is_lifted(robot_report.is_lifted);
  if (robot_report.command) {
    message.command_stamp_ns(to_ns(robot_report.command->sent_at));
    message.command_received_at_ns(to_ns(robot_report.command->received_at));
  }
  message.x_m(robot_report.estimate.position_m.x());
  message.y_m(robot_report.estimate.position_m.y());
  message.vx_mps(robot_report.estimate.velocity_mps.x());
  message.vy_mps(robot_report.estimate.velocity_mps.y());
  message.heading_rad(robot_report.heading_rad);
  message.tracking_error_m(robot_report.tracking_error_m);
  message.position_error_rms_m(robot_report.uncertainty.position_error_rms_m);
  message.odometry_scale_stddev(robot_report.uncertainty.odometry_scale_stddev);
  message.has_moved(robot_report.has_moved);
  message.activated(robot_report.activated);
  message.lead_ns(robot_report.lead.count());
  return message;
}

}  // namespace sidestep
