// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "common/motion/version.hpp"
#include "common/protocol/drop_reasons.hpp"

namespace sidestep {

/// How often a process has dropped something for a reason, since its start.
struct DropCount {
  DropReason reason = DropReason::kUnreadable;
  std::optional<RobotId> robot;  ///< the robot that it concerned; nullopt: none, or one of too many
  std::uint64_t count = 0;
};

/// What a process has dropped, by reason and robot. Allocates nothing. At most kMaxRobotCounts pairs of
/// reason and robot are counted apart, so that a hostile sender can fill no memory; further ones are counted
/// without the robot.
class DropCounters {
 public:
  static constexpr std::size_t kMaxRobotCounts = 256;
  static constexpr std::size_t kCapacity = kDropReasonCount + kMaxRobotCounts;

  DropCounters();

  void count(DropReason reason, std::optional<RobotId> robot = std::nullopt, std::uint64_t times = 1);
  /// Adds the counts of others.
  void add(const DropCounters& others);
  /// Of all robots together.
  std::uint64_t total(DropReason reason) const;
  /// Of all reasons.
  std::uint64_t total() const;
  /// Includes counts of zero.
  std::span<const DropCount> counts() const { return {counts_.data(), size_}; }

 private:
  std::array<DropCount, kCapacity> counts_;  // first those without a robot, by reason
  std::size_t size_ = kDropReasonCount;
};

}  // namespace sidestep
