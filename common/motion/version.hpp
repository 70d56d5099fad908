// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/motion/intent.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

using RobotId = std::uint32_t;
using VersionNumber = std::uint64_t;
/// One life of a process: nanoseconds of its clock when it began, so a later life has a higher one.
using Incarnation = std::uint64_t;
using Epoch = std::uint64_t;
/// What claims to be higher is nobody's epoch.
inline constexpr Epoch kHighestEpoch = Epoch{1} << 62;
/// Epochs are readings of coordinators' clocks, raised a little where one has to be above another. So what is
/// an hour ahead of one's own clock or more is nobody's epoch: one wrong message cannot use up all epochs
/// that there are.
constexpr bool is_believable(Epoch epoch, Time now) {
  constexpr Duration kEpochsAhead{3'600'000'000'000};
  return epoch <= kHighestEpoch && static_cast<std::int64_t>(epoch) - to_ns(now) < kEpochsAhead.count();
}

/// Robots are numbered 0 .. kMaxRobots - 1.
inline constexpr RobotId kMaxRobots = 1024;

/// One trajectory of one robot. An agent counts its versions upwards from its incarnation, so that they grow
/// over the robot's life although agents come and go. Version 0 is the stand that a robot begins with; no
/// agent makes it.
struct Version {
  RobotId robot = 0;
  Incarnation incarnation = 0;
  VersionNumber number = 0;
  VersionNumber base = 0;
  Trajectory trajectory;
  /// How much larger than its radius the robot has to be taken: where it was measured off its reference.
  double inflation_m = 0;
  std::optional<Intent> intent{};
};

}  // namespace sidestep
