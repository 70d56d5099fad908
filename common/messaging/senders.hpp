// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Who a message's head.sender is. Robots and their agents go by the robot's number; everybody else by these.
enum class Sender : std::uint32_t {
  kCoordinator = 10000,
  kVision = 20000,
  kSimulator = 30000,
  kOperator = 40000,
};

/// NetworkFault.target of an order to every process.
inline constexpr std::uint32_t kEveryProcess = 4294967295;

}  // namespace sidestep
