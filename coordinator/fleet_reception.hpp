// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "common/motion/version.hpp"
#include "common/protocol/report_period.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Records the messages that a coordinator, active or standby, receives from robots and their agents. A
/// coordinator that does not hear them cannot serve them. All times are by the coordinator's clock.
class FleetReception {
 public:
  /// Number of cycles without facts after which a robot counts as not heard. If control cycles are short, it
  /// is kMissedGaps of the longest gaps between facts.
  static constexpr int kMissedReports = 5, kMissedGaps = 2;
  /// An agent counts as asking for a coordinator if it repeats its registration at least this often.
  static constexpr Duration kMaxRequestGap{350'000'000};

  explicit FleetReception(Duration cycle)
      : max_silence_(std::max(kMissedReports * cycle, kMissedGaps * max_report_gap(cycle))) {}

  /// Processes a report of the version that a robot executes. `is_granted` is false for an own stop, and if
  /// the robot executes nothing.
  void on_robot_report(RobotId robot, VersionNumber executing, bool is_granted, Time now);
  /// Records that a message of the robot's agent has arrived.
  void on_agent(RobotId robot, Time now);
  void on_vision(Time now) { vision_at_ = now; }
  /// Processes a registration of any epoch, which agents repeat until they are served.
  void on_registration(RobotId robot, Time now);

  /// Whether facts arrive from at least half of the robots that sent any in the last ten seconds. False if no
  /// robot has sent any.
  bool hears_robots(Time now) const;
  /// Whether each of these agents has sent a message recently.
  bool hears_agents(const std::vector<RobotId>& robots, Time now) const;
  /// Whether a world state has arrived recently.
  bool hears_vision(Time now) const;
  /// Whether any robot has begun to execute a granted version within `lately`, which means that some
  /// coordinator grants.
  bool is_fleet_served(Duration lately, Time now) const { return served_at_ && now - *served_at_ < lately; }
  /// When a robot last began to execute a granted version; nullopt if never.
  std::optional<Time> served_at() const { return served_at_; }
  /// How long the robot's agent has been asking for a coordinator since the last forget_requests(), from its
  /// first request to its latest; 0 if it is not asking.
  Duration request_duration(RobotId robot, Time now) const;
  /// Like request_duration(), but from the first request until now.
  Duration time_since_first_request(RobotId robot, Time now) const;
  /// Call when a new epoch has begun: agents must ask again.
  void forget_requests();
  /// Call when the clock was set back: all earlier times are discarded.
  void clear();

 private:
  struct Robot {
    std::optional<Time> report_at, agent_at, requested_at, requested_since;
    VersionNumber executing = 0;
  };
  /// The robot, if its agent is asking for a coordinator; otherwise nullptr.
  const Robot* find_requesting(RobotId robot, Time now) const;

  Duration max_silence_;
  std::map<RobotId, Robot> robots_;
  std::optional<Time> served_at_, vision_at_;
};

}  // namespace sidestep
