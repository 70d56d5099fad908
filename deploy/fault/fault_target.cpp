// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/fault_target.hpp"

#include <charconv>
#include <fmt/format.h>

#include "common/config/scenario.hpp"
#include "common/motion/version.hpp"

namespace sidestep {
namespace {

std::optional<std::uint32_t> parse_number(const std::string& digits, std::uint32_t count) {
  std::uint32_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  if (error != std::errc{} || stop != end || number >= count) return std::nullopt;
  return number;
}

std::uint32_t number_of(Sender sender) { return static_cast<std::uint32_t>(sender); }

}  // namespace

std::optional<FaultTarget> parse_fault_target(const std::string& text) {
  if (text == "all") return FaultTarget{};
  if (text == "vision") return FaultTarget{number_of(Sender::kVision), "sidestep-vision"};
  if (text == "simulator") return FaultTarget{number_of(Sender::kSimulator), "sidestep-simulator"};
  if (text == "coordinator" || text == "coordinator 0")
    return FaultTarget{number_of(Sender::kCoordinator), "sidestep-coordinator"};
  const auto space = text.find(' ');
  if (space == std::string::npos) return std::nullopt;
  const std::string kind = text.substr(0, space), digits = text.substr(space + 1);
  if (kind == "agent") {
    if (const auto robot = parse_number(digits, kMaxRobots))
      return FaultTarget{*robot, fmt::format("agent-{}", *robot)};
  } else if (kind == "coordinator") {
    if (const auto number = parse_number(digits, kMaxCoordinators))
      return FaultTarget{number_of(Sender::kCoordinator) + *number, fmt::format("coordinator-{}", *number)};
  }
  return std::nullopt;
}

}  // namespace sidestep
