// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/motion/intent.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

using RobotId = std::uint32_t;
using VersionNumber = std::uint64_t;
/// Identifies one run of a process: the reading of the process's clock at its start, in nanoseconds. A later
/// run therefore has a higher number.
using Incarnation = std::uint64_t;
using Epoch = std::uint64_t;
/// Whether a message may contain this time. Times an hour or more ahead of the local clock are refused.
constexpr bool is_plausible(Time t, Time now) {
  constexpr Duration kMaxAhead = std::chrono::hours(1);
  return t >= Time{} && t <= kMaxTime && t - now < kMaxAhead;
}
/// Whether a message may contain this incarnation, epoch or version number. All three are clock readings,
/// raised slightly if a number has to exceed another. The check ensures that a single wrong message cannot
/// exhaust the numbers or permanently exclude processes with lower numbers.
constexpr bool is_plausible(std::uint64_t number, Time now) {
  return number <= static_cast<std::uint64_t>(to_ns(kMaxTime)) &&
         is_plausible(time_from_ns(static_cast<std::int64_t>(number)), now);
}

/// Robots are numbered 0 .. kMaxRobots - 1.
inline constexpr RobotId kMaxRobots = 1024;

/// One trajectory of one robot. An agent numbers its versions upwards from its incarnation, so that numbers
/// keep increasing when an agent restarts. Version 0 is the rest version with which a robot starts; no agent
/// creates it.
struct Version {
  RobotId robot = 0;
  Incarnation incarnation = 0;
  VersionNumber number = 0;
  VersionNumber base = 0;
  Trajectory trajectory;
  /// Added to the robot's radius to cover the uncertainty of its position; see coordinator/PROTOCOL.md.
  double inflation_m = 0;
  std::optional<Intent> intent{};
};

}  // namespace sidestep
