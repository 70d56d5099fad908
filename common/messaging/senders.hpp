// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Values of Header.sender. A robot and its agents use the robot's number. The others use these bases, plus
/// their own number where there are several.
enum class Sender : std::uint32_t {
  kCoordinator = 10000,
  kVision = 20000,
  kSimulator = 30000,
  kOperator = 40000,
};

/// Coordinators are numbered 0 .. kMaxCoordinators - 1.
inline constexpr std::uint32_t kMaxCoordinators = 8;

constexpr bool is_coordinator(std::uint32_t sender) {
  const auto first = static_cast<std::uint32_t>(Sender::kCoordinator);
  return sender >= first && sender < first + kMaxCoordinators;
}

/// NetworkFault.target that addresses every process.
inline constexpr std::uint32_t kEveryProcess = 4294967295;

}  // namespace sidestep
