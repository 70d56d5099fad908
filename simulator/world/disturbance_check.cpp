// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/disturbance_check.hpp"

#include <chrono>
#include <cmath>

#include "common/time/time.hpp"

namespace sidestep {
namespace {

constexpr double kMaxPush_mps = 10;
constexpr double kMaxAngle_rad = 100;
constexpr Duration kMaxDuration = std::chrono::hours(1);

// False for NaN.
bool is_within(double value, double bound) { return std::abs(value) <= bound; }

bool has_valid_duration(const msg::Disturbance& message) {
  return message.duration_ns() >= 0 && message.duration_ns() <= kMaxDuration.count();
}

}  // namespace

bool is_valid(const msg::Disturbance& message, const Field& field, double robot_radius_m) {
  switch (message.disturbance_kind()) {
    case msg::DISTURBANCE_PUSH:
      return is_within(message.vx_mps(), kMaxPush_mps) && is_within(message.vy_mps(), kMaxPush_mps);
    case msg::DISTURBANCE_SLIP:
      return message.grip() >= 0 && message.grip() <= 1 && has_valid_duration(message);
    case msg::DISTURBANCE_BLOCK:
      return is_within(message.heading_rad(), kMaxAngle_rad) && has_valid_duration(message);
    case msg::DISTURBANCE_PLACE:
      return is_within(message.heading_rad(), kMaxAngle_rad) && std::isfinite(message.x_m()) &&
             std::isfinite(message.y_m()) && field.contains({message.x_m(), message.y_m()}, robot_radius_m);
    case msg::DISTURBANCE_CLOCK:
      return std::abs(static_cast<double>(message.clock_offset_ns())) <=
             static_cast<double>(kMaxDuration.count());
    case msg::DISTURBANCE_LIFT:
    case msg::DISTURBANCE_REBOOT:
      return true;
  }
  return false;
}

}  // namespace sidestep
