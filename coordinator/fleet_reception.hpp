// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// What a coordinator hears of robots and their agents, whether it is active or stands by. A coordinator that
/// does not hear them cannot serve them. All times are by the coordinator's clock.
class FleetReception {
 public:
  /// Periods of the robots' facts until a robot counts as not heard.
  static constexpr int kMissedFacts = 5;
  /// An agent that repeats its registration at least this often asks for a coordinator.
  static constexpr Duration kMaxRequestGap{350'000'000};

  /// `fact_period`: at which robots report facts.
  explicit FleetReception(Duration fact_period) : max_silence_(kMissedFacts * fact_period) {}

  /// A robot executes this version. `is_granted`: not a stop of its own, and not nothing.
  void on_fact(RobotId robot, VersionNumber executing, bool is_granted, Time now);
  /// Any message of the robot's agent.
  void on_agent(RobotId robot, Time now);
  void on_vision(Time now) { vision_at_ = now; }
  /// A registration, whatever the epoch: agents repeat it until they are served.
  void on_registration(RobotId robot, Time now);

  /// Whether facts arrive of at least half of the robots of which any arrived in the last ten seconds. False
  /// if none did.
  bool hears_robots(Time now) const;
  /// Whether a message of each of these agents has arrived lately.
  bool hears_agents(const std::vector<RobotId>& robots, Time now) const;
  /// Whether a world state has arrived lately.
  bool hears_vision(Time now) const;
  /// Whether robots have begun to execute granted versions in this time, so that somebody grants.
  bool is_fleet_served(Duration lately, Time now) const { return served_at_ && now - *served_at_ < lately; }
  /// When one has last; nullopt: never.
  std::optional<Time> served_at() const { return served_at_; }
  /// For how long the robot's agent has asked for a coordinator since the last forget_requests(), from its
  /// first request to its last; 0 if it does not.
  Duration request_duration(RobotId robot, Time now) const;
  /// The same from its first request until now.
  Duration time_since_first_request(RobotId robot, Time now) const;
  /// A new epoch has begun: the agents have to ask anew.
  void forget_requests();
  /// The clock was set back: earlier times mean nothing.
  void clear();

 private:
  struct Robot {
    std::optional<Time> fact_at, agent_at, requested_at, requested_since;
    VersionNumber executing = 0;
  };
  /// The robot, if its agent asks for a coordinator.
  const Robot* find_asking(RobotId robot, Time now) const;

  Duration max_silence_;
  std::map<RobotId, Robot> robots_;
  std::optional<Time> served_at_, vision_at_;
};

}  // namespace sidestep
