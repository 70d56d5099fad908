// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "common/motion/version.hpp"
#include "common/protocol/drop_reasons.hpp"

namespace sidestep {

/// Number of items that a process has dropped for one reason since its start.
struct DropCount {
  DropReason reason = DropReason::kUnreadable;
  std::optional<RobotId> robot;  ///< the robot concerned; nullopt: none, or too many to count
  std::uint64_t count = 0;
};

/// Numbers of items that a process has dropped, by reason and robot. Allocates nothing. At most
/// kMaxRobotCounts pairs of reason and robot are counted separately, so that a hostile sender cannot fill the
/// memory; further pairs are counted without the robot.
class DropCounters {
 public:
  static constexpr std::size_t kMaxRobotCounts = 256;
  static constexpr std::size_t kCapacity = kDropReasonCount + kMaxRobotCounts;

  DropCounters();

  void count(DropReason reason, std::optional<RobotId> robot = std::nullopt, std::uint64_t times = 1);
  /// Adds another process's or component's counts.
  void add(const DropCounters& others);
  /// The count of a reason over all robots.
  std::uint64_t total(DropReason reason) const;
  /// The count over all reasons.
  std::uint64_t total() const;
  /// All counts, including zeros.
  std::span<const DropCount> counts() const { return {counts_.data(), size_}; }

 private:
  std::array<DropCount, kCapacity> counts_;  // first the counts without a robot, indexed by reason
  std::size_t size_ = kDropReasonCount;
};

}  // namespace sidestep
