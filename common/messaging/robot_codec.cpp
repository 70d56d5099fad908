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

std::optional<Feedback> decode(const msg::Feedback& message, RobotId robot, Time now) {
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
  Feedback feedback;
  feedback.robot = robot;
  feedback.robot_incarnation = message.header().incarnation();
  feedback.obeyed_incarnation = message.obeyed_incarnation();
  feedback.obeyed_epoch = message.obeyed_epoch();
  feedback.valid_at = time_from_ns(message.valid_at_ns());
  feedback.executing = *executing;
  feedback.is_off_reference = message.is_off_reference();
  feedback.is_lifted = message.is_lifted();
  if (message.command_stamp_ns() != 0) {
    feedback.command = {time_from_ns(message.command_stamp_ns()),
                        time_from_ns(message.command_received_at_ns())};
  }
  feedback.estimate = estimate;
  feedback.heading_rad = message.heading_rad();
  feedback.tracking_error_m = message.tracking_error_m();
  feedback.uncertainty = uncertainty;
  feedback.has_moved = message.has_moved();
  feedback.activated = message.activated();
  feedback.lead = Duration{message.lead_ns()};
  return feedback;
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

msg::Feedback encode(const Feedback& feedback) {
  msg::Feedback message;
  message.robot(feedback.robot);
  message.header().sender(feedback.robot);
  message.header().incarnation(feedback.robot_incarnation);
  message.obeyed_incarnation(feedback.obeyed_incarnation);
  message.obeyed_epoch(feedback.obeyed_epoch);
  message.valid_at_ns(to_ns(feedback.valid_at));
  message.executing(encode(feedback.executing));
  message.is_off_reference(feedback.is_off_reference);
  message.is_lifted(feedback.is_lifted);
  if (feedback.command) {
    message.command_stamp_ns(to_ns(feedback.command->sent_at));
    message.command_received_at_ns(to_ns(feedback.command->received_at));
  }
  message.x_m(feedback.estimate.position_m.x());
  message.y_m(feedback.estimate.position_m.y());
  message.vx_mps(feedback.estimate.velocity_mps.x());
  message.vy_mps(feedback.estimate.velocity_mps.y());
  message.heading_rad(feedback.heading_rad);
  message.tracking_error_m(feedback.tracking_error_m);
  message.position_error_rms_m(feedback.uncertainty.position_error_rms_m);
  message.odometry_scale_stddev(feedback.uncertainty.odometry_scale_stddev);
  message.has_moved(feedback.has_moved);
  message.activated(feedback.activated);
  message.lead_ns(feedback.lead.count());
  return message;
}

}  // namespace sidestep
