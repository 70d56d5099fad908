// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/process_names.hpp"

#include <charconv>

namespace sidestep {
namespace {

std::optional<std::uint32_t> parse_process_number(const std::string& digits, std::uint32_t count) {
  std::uint32_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  if (error != std::errc{} || stop != end || number >= count) return std::nullopt;
  return number;
}

}  // namespace

std::optional<std::uint32_t> process_id(const std::string& name) {
  constexpr auto kFirstCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);
  if (name == "vision") return static_cast<std::uint32_t>(Sender::kVision);
  if (name == "simulator") return static_cast<std::uint32_t>(Sender::kSimulator);
  if (name == "robots") return static_cast<std::uint32_t>(Sender::kRobots);
  if (name == "coordinator") return kFirstCoordinator;
  const auto space = name.find(' ');
  if (space == std::string::npos) return std::nullopt;
  const std::string kind = name.substr(0, space), digits = name.substr(space + 1);
  if (kind == "agent") return parse_process_number(digits, kMaxRobots);
  const auto number = kind == "coordinator" ? parse_process_number(digits, kMaxCoordinators) : std::nullopt;
  return number ? std::optional(kFirstCoordinator + *number) : std::nullopt;
}

}  // namespace sidestep
