// SPDX-License-Identifier: Apache-2.0
#include "common/process/process_identity.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <stdexcept>

#include "common/protocol/senders.hpp"

namespace sidestep {

Identity identity_of_process(std::uint32_t process, const Scenario& scenario) {
  if (process < kMaxRobots) return {Role::kAgent, process, process};
  if (is_coordinator(process)) {
    const std::uint32_t number = process - static_cast<std::uint32_t>(Sender::kCoordinator);
    return {Role::kCoordinator, number, number};
  }
  switch (static_cast<Sender>(process)) {
    case Sender::kVision:
      return {Role::kVision};
    case Sender::kSimulator:
      return {Role::kSimulator};
    case Sender::kReferee:
      return {Role::kReferee};
    case Sender::kRobots: {
      const auto [first, last] = std::ranges::minmax(scenario.robots, {}, &RobotSpec::id);
      return {Role::kRobot, first.id, last.id};
    }
    default:
      throw std::logic_error(fmt::format("unknown process id {}", process));
  }
}

}  // namespace sidestep
