// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/messaging/sim/links.hpp"
#include "common/protocol/order.hpp"
#include "common/protocol/robot_disturbance.hpp"
#include "common/time/clock_error.hpp"

namespace sidestep {

using ProcessNames = std::vector<std::string>;

/// Sets the quality of the links between those of these processes that are on different hosts.
struct LinkChange {
  ProcessNames from, to;
  LinkQuality quality;
};
/// Drops all messages between these processes for a while.
struct Partition {
  ProcessNames from, to;
  Duration duration{0};
};
/// Drops all messages from these processes to a coordinator, or from a coordinator to them, for good. The
/// other coordinators have to work without it.
struct LastingCut {
  ProcessNames from, to;
};
/// Sets how far the clock of a process is ahead.
struct ClockJump {
  std::string process;
  Duration offset{0};
};
/// SIGSTOP and, after the duration, SIGCONT.
struct Pause {
  ProcessNames processes;
  Duration duration{0};
  std::size_t max_queued = 0;  ///< messages per process; further ones are lost
};
struct Kill {
  std::string process;
};
/// Starts a dead process, or a robot's second agent.
struct Start {
  std::string process;
};

/// Somebody carries a robot to a place, by hand and at a speed.
struct Carry {
  RobotId robot = 0;
  Vec2 place_m{0, 0};
  double speed_mps = 1;
};
/// The operator puts a lifted robot down. Each place is requested for a while, one after another and again
/// from the first, until one is granted. Without a request that persists, an agent that is dead at the time
/// would never learn of it.
struct Place {
  RobotId robot = 0;
  std::vector<Vec2> places_m;
  double heading_rad = 0;
};
/// The operator takes a robot without power off the floor for good, and attests its absence whenever the
/// coordinator waits for it.
struct TakeAway {
  RobotId robot = 0;
};

/// Starts a process again with a scenario in which one rule differs.
struct StartWithOtherRule {
  std::string process;
  std::size_t rule = 0;  ///< of other_rules()
};
/// Starts such a process again with the right scenario.
struct StartWithOwnRules {
  std::string process;
};
/// A hostile process sends a false message about a robot.
struct SendForgery {
  RobotId victim = 0;
  std::size_t forgery = 0;  ///< of forgeries()
};

/// A client gives an order; its number is set when it is sent.
struct GiveOrder {
  Order order;
};

using Fault =
    std::variant<LinkChange, Partition, Pause, Kill, Start, RobotDisturbance, Carry, Place, TakeAway,
                 StartWithOtherRule, StartWithOwnRules, SendForgery, LastingCut, ClockJump, GiveOrder>;

struct TimedFault {
  Duration at{0};  ///< since the start of the run
  Fault fault;
};

/// In which state a robot is at the end of a run that was not put right for it.
enum class RobotEnd {
  kClockOutOfBound,   ///< its clock was out of bound all the time, so it must not move
  kClockLeftBound,    ///< its clock is so far out of bound that its agent must report it
  kClockBeyondBound,  ///< its clock has left the bound by less
  kLifted,            ///< it is off the floor
  kTakenAway,         ///< it is off the floor and has no power
};

/// All faults of one run. None occurs or persists after `healed_at`, except that robots in `ends` remain as
/// they are, and lasting cuts.
struct FaultPlan {
  std::vector<ProcessNames> hosts;           ///< messages within a host are fast and never lost
  std::map<std::string, ClockError> clocks;  ///< by process
  std::map<RobotId, RobotEnd> ends;          ///< of robots that need not drive at the end; the others must
  std::vector<TimedFault> faults;            ///< sorted by time
  Duration healed_at{0};
};

/// The robots that end in a state; ascending.
[[nodiscard]] std::vector<RobotId> robots_with(const FaultPlan& plan, RobotEnd end);

/// A description with one line per host, clock and fault.
std::vector<std::string> to_lines(const FaultPlan& plan);

}  // namespace sidestep
