// SPDX-License-Identifier: Apache-2.0
#include "simulator/disturbance_check.hpp"

#include <chrono>
#include <cmath>

#include "common/time/time.hpp"

namespace sidestep {
namespace {

constexpr double kHardestPush_mps = 10;
constexpr double kLargestAngle_rad = 100;
constexpr Duration kLongest = std::chrono::hours(1);

// Written so that a NaN fails it.
bool within(double value, double bound) { return std::abs(value) <= bound; }

bool lasts(const msg::Disturbance& message) {
  return message.duration_ns() >= 0 && message.duration_ns() <= kLongest.count();
}

}  // namespace

bool is_sound(const msg::Disturbance& message, const Field& field, double robot_radius_m) {
  switch (message.disturbance_kind()) {
    case msg::DISTURBANCE_PUSH:
      return within(message.vx_mps(), kHardestPush_mps) && within(message.vy_mps(), kHardestPush_mps);
    case msg::DISTURBANCE_SLIP:
      return message.grip() >= 0 && message.grip() <= 1 && lasts(message);
    case msg::DISTURBANCE_BLOCK:
      return within(message.heading_rad(), kLargestAngle_rad) && lasts(message);
    case msg::DISTURBANCE_PLACE:
      return within(message.heading_rad(), kLargestAngle_rad) && std::isfinite(message.x_m()) &&
             std::isfinite(message.y_m()) && field.contains({message.x_m(), message.y_m()}, robot_radius_m);
    case msg::DISTURBANCE_CLOCK:
      return std::abs(static_cast<double>(message.clock_offset_ns())) <=
             static_cast<double>(kLongest.count());
    case msg::DISTURBANCE_LIFT:
    case msg::DISTURBANCE_REBOOT:
      return true;
  }
  return false;
}

}  // namespace sidestep
