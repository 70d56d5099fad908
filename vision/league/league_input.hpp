// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/messaging/dds/bus.hpp"
#include "common/time/rate_limit.hpp"
#include "vision/league/league_source.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep {

/// Where the league's packets are received.
struct LeagueAddress {
  std::string endpoint;  ///< ADDRESS:PORT of the multicast group
  std::string interface = league::kLeagueInterface;
};

/// Feeds a vision node with detections from the league's multicast, and logs problems. Precondition: the bus
/// makes no callbacks after this object's destruction. Throws what MulticastReceiver and LeagueSource throw.
class LeagueInput {
 public:
  LeagueInput(DdsBus& bus, const Scenario& scenario, const LeagueAddress& address, VisionNode& node);
  LeagueInput(const LeagueInput&) = delete;
  LeagueInput& operator=(const LeagueInput&) = delete;

 private:
  void handle(std::span<const std::byte> datagram, const league::Endpoint& sender);
  void report_silence();
  void report_rejection(const league::Endpoint& sender);
  void report_field();
  void report_clock_jump(const league::Endpoint& sender);
  void report_clock(const league::Endpoint& sender);

  DdsBus& bus_;
  LeagueAddress address_;
  Field field_;
  VisionNode& node_;
  LeagueSource source_;
  league::MulticastReceiver receiver_;
  std::uint64_t next_report_ = 1;  ///< number of rejected packets at which the next report is due
  bool has_reported_field_ = false;
  std::uint64_t reported_jumps_ = 0;
  SenderClockKind reported_kind_ = SenderClockKind::kSteady;
  RateLimit clock_reports_{1, std::chrono::seconds(5)};
};

}  // namespace sidestep
