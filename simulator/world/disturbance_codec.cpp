// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/disturbance_codec.hpp"

#include <chrono>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kMaxAngle_rad = 100;
constexpr double kMaxVisionOffset_m = 10;
constexpr Duration kMaxDuration = std::chrono::hours(1);

// Whether the magnitude of a value is at most `bound`; false for NaN.
bool is_within(double value, double bound) { return std::abs(value) <= bound; }

bool has_valid_duration(const RobotDisturbance& disturbance) {
  return disturbance.duration >= Duration{0} && disturbance.duration <= kMaxDuration;
}

bool is_valid(const RobotDisturbance& disturbance, const Field& field, double robot_radius_m) {
  switch (disturbance.kind) {
    case msg::DisturbanceKind::DISTURBANCE_PUSH:
      return is_within(disturbance.push_mps.x(), kMaxPush_mps) &&
             is_within(disturbance.push_mps.y(), kMaxPush_mps);
    case msg::DisturbanceKind::DISTURBANCE_SLIP:
      return disturbance.grip >= 0 && disturbance.grip <= 1 && has_valid_duration(disturbance);
    case msg::DisturbanceKind::DISTURBANCE_BLOCK:
      return is_within(disturbance.heading_rad, kMaxAngle_rad) && has_valid_duration(disturbance);
    case msg::DisturbanceKind::DISTURBANCE_PLACE:
      return is_within(disturbance.heading_rad, kMaxAngle_rad) && disturbance.place_m.allFinite() &&
             field.contains(disturbance.place_m, robot_radius_m);
    case msg::DisturbanceKind::DISTURBANCE_CLOCK:
      return disturbance.clock_offset >= -kMaxDuration && disturbance.clock_offset <= kMaxDuration;
    case msg::DisturbanceKind::DISTURBANCE_CARRY:
      return has_valid_duration(disturbance) && disturbance.duration > Duration{0} &&
             disturbance.place_m.allFinite() && field.contains(disturbance.place_m, robot_radius_m);
    case msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE:
      return has_valid_duration(disturbance) && is_within(disturbance.place_m.x(), kMaxVisionOffset_m) &&
             is_within(disturbance.place_m.y(), kMaxVisionOffset_m);
    case msg::DisturbanceKind::DISTURBANCE_SEEN_AS:
    case msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN:
      return has_valid_duration(disturbance);
    case msg::DisturbanceKind::DISTURBANCE_LIFT:
    case msg::DisturbanceKind::DISTURBANCE_REBOOT:
    case msg::DisturbanceKind::DISTURBANCE_FORGET_POSE:
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF:
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_ON:
      return true;
  }
  return false;
}

}  // namespace

std::optional<RobotDisturbance> decode(const msg::Disturbance& message, const Field& field,
                                       double robot_radius_m) {
  const RobotDisturbance disturbance{message.robot(),
                                     message.disturbance_kind(),
                                     {message.vx_mps(), message.vy_mps()},
                                     message.grip(),
                                     {message.x_m(), message.y_m()},
                                     message.heading_rad(),
                                     Duration{message.clock_offset_ns()},
                                     Duration{message.duration_ns()},
                                     message.other_robot()};
  return is_valid(disturbance, field, robot_radius_m) ? std::optional(disturbance) : std::nullopt;
}

msg::Disturbance encode(const RobotDisturbance& disturbance) {
  msg::Disturbance message;
  message.robot(disturbance.robot);
  message.disturbance_kind(disturbance.kind);
  message.vx_mps(disturbance.push_mps.x());
  message.vy_mps(disturbance.push_mps.y());
  message.grip(disturbance.grip);
  message.x_m(disturbance.place_m.x());
  message.y_m(disturbance.place_m.y());
  message.heading_rad(disturbance.heading_rad);
  message.clock_offset_ns(disturbance.clock_offset.count());
  message.duration_ns(disturbance.duration.count());
  message.other_robot(disturbance.other_robot);
  return message;
}

}  // namespace sidestep
