// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/league/multicast.hpp"
#include "common/messaging/bus.hpp"
#include "simulator/league/league_frames.hpp"
#include "simulator/world/simulator_node.hpp"

namespace sidestep {

/// Sends the detections of a simulator's cameras to the league's multicast address, and the geometry every 3
/// s. The bus must make no callback after this object's destruction. Throws as MulticastSender,
/// parse_multicast_endpoint() and LeagueFrames do.
class LeagueOutput {
 public:
  LeagueOutput(Bus& bus, const Scenario& scenario, SimulatorNode& simulator, const std::string& endpoint,
               const std::string& interface);
  LeagueOutput(const LeagueOutput&) = delete;
  LeagueOutput& operator=(const LeagueOutput&) = delete;

 private:
  void send(const league::VisionPacket& packet);
  void send_geometry();

  Bus& bus_;
  const EventReporter& events_;
  LeagueFrames frames_;
  league::MulticastSender sender_;
  std::uint64_t next_report_ = 1;
};

}  // namespace sidestep
