// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/messaging/sim/links.hpp"
#include "common/protocol/order.hpp"
#include "common/protocol/robot_disturbance.hpp"
#include "common/time/clock_error.hpp"
#include "deploy/trial/fault/fault_schedule.hpp"
#include "deploy/trial/fault/process_faults.hpp"

namespace sidestep {

/// Sets the quality of the links between these processes where they are on different hosts.
struct LinkChange {
  ProcessNames from, to;
  LinkQuality quality;
};
/// Sets how far the clock of a process is ahead.
struct ClockJump {
  std::string process;
  Duration offset{0};
};
/// Starts a dead process, or a second agent for a robot.
struct Start {
  std::string process;
};

/// A person carries a robot to a place at a given speed.
struct Carry {
  RobotId robot = 0;
  Vec2 place_m{0, 0};
  double speed_mps = 1;
};
/// The operator puts a lifted robot down. The places are requested in rotation, each for a while, until one
/// is granted. Requests are repeated because an agent that is dead when a request is sent would otherwise
/// never receive it.
struct Place {
  RobotId robot = 0;
  std::vector<Vec2> places_m;
  double heading_rad = 0;
};
/// The operator permanently takes a robot without power off the floor, and attests its absence whenever the
/// coordinator awaits it.
struct TakeAway {
  RobotId robot = 0;
};

/// Restarts a process with a scenario in which one rule differs.
struct StartWithMutatedRule {
  std::string process;
  std::size_t rule = 0;  ///< index in rule_mutations()
};
/// Restarts a process that has a mutated rule, with the correct scenario.
struct StartWithOwnRules {
  std::string process;
};
/// A hostile process sends a false message about a robot.
struct SendForgery {
  RobotId victim = 0;
  std::size_t forgery = 0;  ///< index in forgeries()
};

/// A client gives an order; the order's number is set when it is sent.
struct GiveOrder {
  Order order;
};

using Fault =
    std::variant<LinkChange, Partition, Pause, Kill, Start, RobotDisturbance, Carry, Place, TakeAway,
                 StartWithMutatedRule, StartWithOwnRules, SendForgery, ClockJump, GiveOrder>;

struct TimedFault {
  Duration at{0};  ///< time since the start of the run
  Fault fault;
  /// Duration of a partition or pause. A partition without a duration is permanent: messages between one
  /// coordinator and these processes are lost in at least one direction, and the other coordinators must work
  /// without it.
  std::optional<Duration> duration = std::nullopt;

  FaultSpan span() const { return {at, duration ? std::optional(at + *duration) : std::nullopt}; }
};

/// The state of a robot at the end of a run if its fault is not corrected.
enum class RobotEnd {
  kClockOutOfBound,   ///< its clock was out of bounds throughout, so it must not move
  kClockLeftBound,    ///< its clock is so far out of bounds that its agent must report it
  kClockBeyondBound,  ///< its clock has left the bound by a smaller amount
  kLifted,            ///< it is off the floor
  kTakenAway,         ///< it is off the floor and has no power
};

/// All faults of one run. None occurs or persists after `healed_at`, except partitions without a
/// duration and the states of robots in `ends`.
struct FaultPlan {
  std::vector<ProcessNames> hosts;           ///< messages within a host are fast and never lost
  std::map<std::string, ClockError> clocks;  ///< indexed by process
  /// States of robots that need not drive at the end; all other robots must drive.
  std::map<RobotId, RobotEnd> ends;
  std::vector<TimedFault> faults;  ///< sorted by time
  Duration healed_at{0};

  /// Adds a fault unless all faults have ended by then.
  void add(Duration at, Fault fault, std::optional<Duration> duration = std::nullopt) {
    if (at < healed_at) faults.push_back({at, std::move(fault), duration});
  }
};

/// The robots that end in a given state, sorted.
[[nodiscard]] std::vector<RobotId> robots_with(const FaultPlan& plan, RobotEnd end);

/// A description with one line per host, clock and fault.
std::vector<std::string> to_lines(const FaultPlan& plan);

}  // namespace sidestep
