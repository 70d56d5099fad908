// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "agents/adapters/driver.hpp"
#include "common/config/scenario.hpp"
#include "common/league/control_packet.hpp"
#include "common/league/unicast.hpp"
#include "common/log/log_event.hpp"

namespace sidestep {

/// Ports on which a league simulator receives the commands of each team.
struct LeaguePorts {
  league::Endpoint blue, yellow;
};

/// Drives robots through the Small Size League's simulation protocol. It sends one datagram per team and
/// period, with velocities in the robot's frame, which all simulators accept. The simulator's answers only
/// report errors.
class LeagueDriver : public Driver {
 public:
  /// Precondition: `robots` belong to the scenario. Throws std::invalid_argument if two of the robots have
  /// the same team and number.
  LeagueDriver(const Scenario& scenario, const std::vector<RobotId>& robots, const LeaguePorts& ports);

  void send(std::span<const BaseCommand> commands) override;
  void count_drops(DropCounters& drops) const override;

  /// A file descriptor that becomes readable when an answer has arrived. Then call receive().
  int descriptor() const { return socket_.descriptor(); }
  void receive();

  void on_event(LogLevel min_level, OnLogEvent callback) {
    events_.set_listener(min_level, std::move(callback));
  }
  /// Number of answers received so far.
  std::uint64_t answers() const { return answers_; }

 private:
  struct Name {
    Team team;
    std::uint32_t number;
  };
  void report_error(const league::SimulatorError& error, const league::Endpoint& from);

  LeaguePorts ports_;
  league::UnicastSocket socket_{std::nullopt};
  std::unordered_map<RobotId, Name> names_;
  std::array<league::TeamCommands, 2> packets_;  ///< indexed by team
  EventReporter events_;
  std::uint64_t answers_ = 0, malformed_ = 0, errors_ = 0;
  std::uint64_t next_error_report_ = 1;
};

}  // namespace sidestep
