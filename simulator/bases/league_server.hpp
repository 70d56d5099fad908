// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/league/unicast.hpp"
#include "common/random/rng.hpp"
#include "simulator/bases/answer_batch.hpp"
#include "simulator/bases/league_commands.hpp"
#include "simulator/bases/velocity_robot_sim_node.hpp"

namespace sidestep {

/// Ports to which clients of the league's simulation protocol send their commands.
struct LeagueServerPorts {
  league::Endpoint control, blue, yellow;
};

/// Differences between the league's simulators in how they serve the protocol.
struct LeagueServerSettings {
  bool accepts_global = false;  ///< also accepts velocities in the world frame
  double loss = 0;              ///< probability that a command packet is lost
  /// Number of a team's command packets that are answered together, to the sender of the last one.
  std::uint32_t packets_per_answer = 1;
};

/// Serves the Small Size League's simulation protocol for a simulated floor: it sends a response to the
/// sender of every datagram. Malformed datagrams are counted and get no response. Throws std::runtime_error
/// if a port is in use.
class LeagueServer {
 public:
  LeagueServer(VelocityRobotSimNode& node, const LeagueServerPorts& ports,
               const LeagueServerSettings& settings = {});

  /// `watch` must call `readable` whenever `descriptor` is readable.
  void start(const std::function<void(int descriptor, std::function<void()> readable)>& watch);

 private:
  void receive_team(Team team, league::UnicastSocket& socket, AnswerBatch& answers);
  void receive_control();
  template <typename Packet>
  bool accept(const league::Decoded<Packet>& decoded, const league::Endpoint& from);

  VelocityRobotSimNode& node_;
  LeagueServerSettings settings_;
  league::UnicastSocket control_, blue_, yellow_;
  AnswerBatch blue_answers_, yellow_answers_;
  Rng rng_{2};
  std::uint64_t malformed_ = 0, lost_ = 0, next_report_ = 1;
};

}  // namespace sidestep
