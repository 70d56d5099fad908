// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/disturbance_answer.hpp"

#include <fmt/format.h>

#include "common/messaging/enumerator.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {

std::optional<msg::DisturbanceResult> result_in(const msg::DisturbanceAnswer& answer,
                                                const msg::Disturbance& disturbance) {
  const bool is_answer = answer.header().sender() == static_cast<std::uint32_t>(Sender::kSimulator) &&
                         answer.robot() == disturbance.robot() &&
                         answer.disturbance_incarnation() == disturbance.header().incarnation() &&
                         answer.disturbance_number() == disturbance.header().message_number() &&
                         is_enumerator(answer.result(), msg::DisturbanceResult::FAULT_NOT_CONFUSABLE);
  return is_answer ? std::optional(answer.result()) : std::nullopt;
}

std::string refusal_text(RobotId robot, msg::DisturbanceResult result) {
  switch (result) {
    case msg::DisturbanceResult::FAULT_UNKNOWN_ROBOT:
      return fmt::format("no robot {} in this run", robot);
    case msg::DisturbanceResult::FAULT_ON_FLOOR:
      return fmt::format("robot {} is on the floor", robot);
    case msg::DisturbanceResult::FAULT_OFF_FLOOR:
      return fmt::format("robot {} is off the floor", robot);
    case msg::DisturbanceResult::FAULT_SWITCHED_OFF:
      return fmt::format("robot {} is switched off", robot);
    case msg::DisturbanceResult::FAULT_SWITCHED_ON:
      return fmt::format("robot {} is switched on", robot);
    case msg::DisturbanceResult::FAULT_NOT_CONFUSABLE:
      return fmt::format("cameras cannot confuse robot {} with the other robot", robot);
    case msg::DisturbanceResult::FAULT_INVALID:
    case msg::DisturbanceResult::FAULT_APPLIED:
      break;
  }
  return "a value is out of range, or the place is outside the field";
}

}  // namespace sidestep
