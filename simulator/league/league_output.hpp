// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/league/multicast.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/protocol/drop_counters.hpp"
#include "common/random/rng.hpp"
#include "simulator/league/league_frames.hpp"
#include "simulator/league/packet_times.hpp"

namespace sidestep {

/// Differences between the league's simulators in how they send packets.
struct LeagueTraits {
  Duration geometry_period = std::chrono::seconds(3);  ///< 0: with every frame
  PacketTimeSettings times{};
  double loss = 0;  ///< probability that a packet of detections is not sent
};

/// Sends the detections of a simulator's cameras to the league's multicast address, and the geometry once per
/// geometry_period. The bus must make no callback after this object's destruction. Throws what
/// MulticastSender, parse_multicast_endpoint() and LeagueFrames throw.
class LeagueOutput {
 public:
  LeagueOutput(Bus& bus, const EventReporter& events, const Scenario& scenario,
               std::span<const CameraView> views, const std::string& endpoint, const std::string& interface,
               const LeagueTraits& traits = {});
  LeagueOutput(const LeagueOutput&) = delete;
  LeagueOutput& operator=(const LeagueOutput&) = delete;

  /// Sends a frame of a simulation whose time is real time.
  void send(const msg::DetectionFrame& frame);
  /// `simulated` counts from the simulation's start.
  void send(const msg::DetectionFrame& frame, const FrameStamps& simulated);
  void count_drops(DropCounters& drops) const;

 private:
  void send(const league::VisionPacket& packet);
  void send_geometry();

  Bus& bus_;
  const EventReporter& events_;
  LeagueFrames frames_;
  LeagueTraits traits_;
  Time begin_;
  league::MulticastSender sender_;
  Rng rng_{1};
  std::uint64_t lost_ = 0, next_report_ = 1;
};

}  // namespace sidestep
