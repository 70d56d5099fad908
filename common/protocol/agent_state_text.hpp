// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/monitor.hpp"

namespace sidestep {

/// Why a robot does not drive, by the state that its agent reports: "it is off the floor". Null if the agent
/// is at work or has nothing to do. Used by commands and reports.
constexpr const char* hindrance_text(msg::AgentState state) {
  switch (state) {
    case msg::AgentState::AGENT_FENCING:
      return "it does not answer its agent";
    case msg::AgentState::AGENT_REGISTERING:
      return "no coordinator has registered it";
    case msg::AgentState::AGENT_WAITING:
      return "its agent waits for other robots, vision or a coordinator";
    case msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND:
      return "clocks differ by more than the safety budget allows";
    case msg::AgentState::AGENT_ABSENT:
      return "it is off the floor";
    case msg::AgentState::AGENT_HELD:
      return "an order holds it";
    case msg::AgentState::AGENT_DRIVING:
    case msg::AgentState::AGENT_ARRIVED:
    case msg::AgentState::AGENT_WITHOUT_ORDER:
      break;
  }
  return nullptr;
}

}  // namespace sidestep
