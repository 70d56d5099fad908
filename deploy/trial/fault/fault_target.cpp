// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/fault_target.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

constexpr std::string_view kAgentPrefix = "agent-", kCoordinatorPrefix = "coordinator-", kRobots = "robots";
constexpr std::array<std::string_view, 5> kSingleProcesses{"sidestep-coordinator", "sidestep-vision",
                                                           "sidestep-simulator", "sidestep-referee", kRobots};

std::string participant_of(std::uint32_t id) {
  constexpr auto kFirstCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);
  if (id < kMaxRobots) return fmt::format("{}{}", kAgentPrefix, id);
  if (is_coordinator(id) && id != kFirstCoordinator)
    return fmt::format("{}{}", kCoordinatorPrefix, id - kFirstCoordinator);
  if (id == static_cast<std::uint32_t>(Sender::kRobots)) return std::string(kRobots);
  return "sidestep-" + process_name(id);
}

bool is_system_process(const std::string& participant) {
  return participant.starts_with(kAgentPrefix) || participant.starts_with(kCoordinatorPrefix) ||
         std::ranges::find(kSingleProcesses, participant) != kSingleProcesses.end();
}

}  // namespace

std::optional<FaultTarget> parse_fault_target(const std::string& text) {
  if (text == "all") return FaultTarget{};
  const auto id = process_id(text);
  return id ? std::optional(FaultTarget{*id, participant_of(*id)}) : std::nullopt;
}

std::vector<std::string> without_observers(std::vector<std::string> subscribers) {
  std::erase_if(subscribers, [](const std::string& name) { return !is_system_process(name); });
  return subscribers;
}

}  // namespace sidestep
