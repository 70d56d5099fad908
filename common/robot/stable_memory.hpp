// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep::robot {

/// The state that a robot must keep across restarts. It changes when another agent or coordinator takes over,
/// and otherwise about once a day, so it may be stored in flash memory.
struct DurableState {
  std::uint64_t incarnation = 0;   ///< incarnation of the agent that the robot obeys; 0: none
  std::uint64_t epoch = 0;         ///< epoch that the robot obeys; 0: none
  std::uint64_t number_bound = 0;  ///< upper bound of all numbers that the robot has received or used
  bool has_moved = false;          ///< the robot may have executed a granted version

  bool operator==(const DurableState&) const = default;
};

/// The robot's memory that survives restarts and loss of power.
class StableMemory {
 public:
  /// Returns true once the state is stored so that it survives a restart; false if it cannot be stored.
  [[nodiscard]] virtual bool store(const DurableState& state) = 0;

 protected:
  ~StableMemory() = default;
};

}  // namespace sidestep::robot
