// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/motion/intent.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

using RobotId = std::uint32_t;
using VersionNumber = std::uint64_t;
/// Identifies one run of a process: the process's clock at its start in nanoseconds, so a later run has a
/// higher number.
using Incarnation = std::uint64_t;
using Epoch = std::uint64_t;
/// Higher epochs are invalid.
inline constexpr Epoch kMaxEpoch = Epoch{1} << 62;
/// Whether a coordinator may have begun this epoch. Epochs are clock readings of coordinators, raised
/// slightly where one has to exceed another, so an epoch an hour or more ahead of the local clock is
/// rejected: a single wrong message cannot exhaust the epochs.
constexpr bool is_plausible(Epoch epoch, Time now) {
  constexpr Duration kMaxEpochAhead{3'600'000'000'000};
  return epoch <= kMaxEpoch && static_cast<std::int64_t>(epoch) - to_ns(now) < kMaxEpochAhead.count();
}

/// Robots are numbered 0 .. kMaxRobots - 1.
inline constexpr RobotId kMaxRobots = 1024;

/// One trajectory of one robot. An agent numbers its versions upwards from its incarnation, so that the
/// numbers increase over the robot's life across restarts of its agent. Version 0 is the rest version with
/// which a robot starts; no agent creates it.
struct Version {
  RobotId robot = 0;
  Incarnation incarnation = 0;
  VersionNumber number = 0;
  VersionNumber base = 0;
  Trajectory trajectory;
  /// Added to the robot's radius because its position is uncertain; coordinator/PROTOCOL.md.
  double inflation_m = 0;
  std::optional<Intent> intent{};
};

}  // namespace sidestep
