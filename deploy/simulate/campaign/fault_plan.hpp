// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/messaging/sim/sim_links.hpp"
#include "common/motion/version.hpp"
#include "idl/disturbance.h"

namespace sidestep {

using ProcessNames = std::vector<std::string>;

/// From now on messages between different hosts, from these to those processes, fare like this.
struct WeatherChange {
  ProcessNames from, to;
  LinkQuality quality;
};
/// For a while nothing that these send gets to those.
struct Partition {
  ProcessNames from, to;
  Duration duration{0};
};
/// SIGSTOP and, after the duration, SIGCONT.
struct Pause {
  ProcessNames processes;
  Duration duration{0};
  std::size_t most_waiting = 0;  ///< messages for each; the others are lost
};
struct Kill {
  std::string process;
};
/// Of a process that is dead, or of a robot's second agent.
struct Start {
  std::string process;
};

/// Somebody's hand on a robot.
struct Hand {
  RobotId robot = 0;
  msg::DisturbanceKind kind = msg::DISTURBANCE_PUSH;
  Vec2 push_mps{0, 0};
  double grip = 1;         ///< of a robot that slips
  double heading_rad = 0;  ///< of the wheel that is blocked
  Duration duration{0};
};

using Fault = std::variant<WeatherChange, Partition, Pause, Kill, Start, Hand>;

struct TimedFault {
  Duration at{0};  ///< from the begin of the run
  Fault fault;
};

/// What goes wrong in one run, drawn up front. From `healed_at` on nothing does: the network is perfect,
/// nobody is stopped or dies any more.
struct FaultPlan {
  std::vector<ProcessNames> hosts;         ///< within a host messages are fast and are not lost
  std::map<std::string, Duration> clocks;  ///< ahead of true time, by process
  std::vector<RobotId> off_clock;          ///< robots whose clocks are so wrong that they must not move
  std::vector<TimedFault> faults;          ///< by time
  Duration healed_at{0};
};

/// One line for each host, clock and fault.
std::vector<std::string> in_words(const FaultPlan& plan);

}  // namespace sidestep
