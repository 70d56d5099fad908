// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/motion/version.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {

/// The name of a robot's agent in messages, reports and hosts files: "agent 3".
inline std::string agent_process(RobotId robot) { return "agent " + std::to_string(robot); }

/// The name of a coordinator in messages, reports and hosts files: "coordinator", "coordinator 1".
inline std::string coordinator_process(int number) {
  return number == 0 ? "coordinator" : "coordinator " + std::to_string(number);
}

/// The name of the process with this id (see senders.hpp). A robot's number names its agent.
inline std::string process_name(std::uint32_t id) {
  if (id < kMaxRobots) return agent_process(id);
  const auto is = [id](Sender sender) { return id == static_cast<std::uint32_t>(sender); };
  if (is(Sender::kVision)) return "vision";
  if (is(Sender::kSimulator)) return "simulator";
  if (is(Sender::kRobots)) return "robots";
  if (is(Sender::kOperator)) return "operator";
  if (is(Sender::kReferee)) return "referee";
  if (is_coordinator(id))
    return coordinator_process(static_cast<int>(id - static_cast<std::uint32_t>(Sender::kCoordinator)));
  return "process " + std::to_string(id);
}

/// The id of the process with this name; accepts "coordinator 0". nullopt unless it names an agent, a
/// coordinator, vision, the simulator or robots.
[[nodiscard]] std::optional<std::uint32_t> process_id(const std::string& name);

}  // namespace sidestep
