// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/motion/version.hpp"
#include "common/robot/stable_memory.hpp"

namespace sidestep {

/// A lock held by the only process that drives a robot. It is released whenever that process ends.
class MemoryLock {
 public:
  /// Throws std::runtime_error if another process holds it, or with the reason if the file cannot be written.
  explicit MemoryLock(const std::string& path);
  ~MemoryLock();
  MemoryLock(const MemoryLock&) = delete;
  MemoryLock& operator=(const MemoryLock&) = delete;

 private:
  int file_;
};

/// A robot's memory as a text file, robot-3.memory, in a folder of this host.
class RobotMemory final : public robot::StableMemory {
 public:
  /// Reads the file if it exists, and creates the folder. Throws std::runtime_error with the file, the line
  /// and the reason if the file cannot be read or is not a robot's memory, because a robot that has forgotten
  /// which agent it obeys must not drive. Also throws if another process holds this robot's memory, because
  /// only one process may drive a robot.
  RobotMemory(const std::string& folder, RobotId robot);

  const robot::DurableState& state() const { return state_; }
  /// Replaces the file atomically and waits until it is on the disk.
  [[nodiscard]] bool store(const robot::DurableState& state) override;
  /// Why the last store() failed; empty if it did not.
  const std::string& failure() const { return failure_; }

 private:
  std::string folder_, path_, failure_;
  std::optional<MemoryLock> lock_;
  robot::DurableState state_;
};

/// $XDG_STATE_HOME/sidestep/robots, by default ~/.local/state/sidestep/robots.
std::string default_memory_folder();

}  // namespace sidestep
