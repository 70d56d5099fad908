// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/fault_target.hpp"

#include <fmt/format.h>

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

std::string participant_of(std::uint32_t id) {
  constexpr auto kFirstCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);
  if (id < kMaxRobots) return fmt::format("agent-{}", id);
  if (is_coordinator(id) && id != kFirstCoordinator)
    return fmt::format("coordinator-{}", id - kFirstCoordinator);
  return "sidestep-" + process_name(id);
}

}  // namespace

std::optional<FaultTarget> parse_fault_target(const std::string& text) {
  if (text == "all") return FaultTarget{};
  const auto id = process_id(text);
  return id ? std::optional(FaultTarget{*id, participant_of(*id)}) : std::nullopt;
}

}  // namespace sidestep
