// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/league/unicast.hpp"
#include "simulator/bases/bases_node.hpp"
#include "simulator/bases/league_commands.hpp"

namespace sidestep {

/// Where clients of the league's simulation protocol send their commands.
struct LeagueServerPorts {
  league::Endpoint control, blue, yellow;
};

/// Serves the Small Size League's simulation protocol for a simulated floor: answers every datagram to its
/// sender. Malformed datagrams are counted and get no answer. Throws std::runtime_error if a port is in use.
class LeagueServer {
 public:
  LeagueServer(BasesNode& node, const LeagueServerPorts& ports, bool accepts_global);

  /// `watch` calls back whenever a descriptor is readable.
  void start(const std::function<void(int descriptor, std::function<void()> readable)>& watch);

 private:
  void receive_team(Team team, league::UnicastSocket& socket);
  void receive_control();
  template <typename Packet>
  bool accept(const league::Decoded<Packet>& decoded, const league::Endpoint& from);

  BasesNode& node_;
  bool accepts_global_;
  league::UnicastSocket control_, blue_, yellow_;
  std::uint64_t malformed_ = 0, next_report_ = 1;
};

}  // namespace sidestep
