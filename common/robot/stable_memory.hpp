// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep::robot {

/// What a robot must still know after a restart. It changes when another agent or coordinator takes over, and
/// otherwise about once a day, so it may be kept in flash memory.
struct DurableState {
  std::uint64_t incarnation = 0;   ///< of the agent that the robot obeys, 0: none
  std::uint64_t epoch = 0;         ///< that it obeys, 0: none
  std::uint64_t number_bound = 0;  ///< not exceeded by any number that the robot has received or used
  bool has_moved = false;          ///< may have executed a granted version

  bool operator==(const DurableState&) const = default;
};

/// The robot's memory that outlives restarts and loss of power.
class StableMemory {
 public:
  /// Returns only when the state will be found after a restart; false if it cannot be stored.
  [[nodiscard]] virtual bool store(const DurableState& state) = 0;

 protected:
  ~StableMemory() = default;
};

}  // namespace sidestep::robot
