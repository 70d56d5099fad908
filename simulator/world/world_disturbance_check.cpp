// SPDX-License-Identifier: Apache-2.0
// Which disturbances a robot's state allows.
#include <algorithm>

#include "simulator/world/world.hpp"

namespace sidestep {
namespace {

constexpr auto kAllowed = msg::DisturbanceResult::FAULT_APPLIED;

}  // namespace

msg::DisturbanceResult World::check_disturbance(std::size_t index,
                                                const RobotDisturbance& disturbance) const {
  using Result = msg::DisturbanceResult;
  const bool is_powered = robots_[index].is_powered, is_on_floor = bodies_[index].is_on_floor();
  switch (disturbance.kind) {
    case msg::DisturbanceKind::DISTURBANCE_PUSH:
    case msg::DisturbanceKind::DISTURBANCE_CARRY:
      return is_on_floor ? kAllowed : Result::FAULT_OFF_FLOOR;
    case msg::DisturbanceKind::DISTURBANCE_PLACE:
      return is_on_floor ? Result::FAULT_ON_FLOOR : kAllowed;
    case msg::DisturbanceKind::DISTURBANCE_FORGET_POSE:
      if (!is_powered) return Result::FAULT_SWITCHED_OFF;
      return is_on_floor ? kAllowed : Result::FAULT_OFF_FLOOR;
    case msg::DisturbanceKind::DISTURBANCE_REBOOT:
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF:
      return is_powered ? kAllowed : Result::FAULT_SWITCHED_OFF;
    case msg::DisturbanceKind::DISTURBANCE_SWITCH_ON:
      return is_powered ? Result::FAULT_SWITCHED_ON : kAllowed;
    case msg::DisturbanceKind::DISTURBANCE_SEEN_AS:
      return confusable_with(index, disturbance) ? kAllowed : Result::FAULT_NOT_CONFUSABLE;
    case msg::DisturbanceKind::DISTURBANCE_SLIP:
    case msg::DisturbanceKind::DISTURBANCE_BLOCK:
    case msg::DisturbanceKind::DISTURBANCE_LIFT:
    case msg::DisturbanceKind::DISTURBANCE_CLOCK:
    case msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE:
    case msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN:
      return kAllowed;
  }
  return Result::FAULT_INVALID;
}

std::optional<std::size_t> World::confusable_with(std::size_t index,
                                                  const RobotDisturbance& disturbance) const {
  const auto other = std::ranges::find(robots_, disturbance.other_robot, &Robot::id);
  if (other == robots_.end()) return std::nullopt;
  const auto other_index = static_cast<std::size_t>(other - robots_.begin());
  if (other_index == index || vision_faults_[index].shown_as || vision_faults_[other_index].shown_as)
    return std::nullopt;
  return other_index;
}

}  // namespace sidestep
