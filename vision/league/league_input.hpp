// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/messaging/dds/dds_bus.hpp"
#include "vision/league/league_source.hpp"
#include "vision/vision_node.hpp"

namespace sidestep {

/// Where the league's packets come from and go to.
struct LeagueAddress {
  std::string endpoint;  ///< ADDRESS:PORT of a group
  std::string interface = league::kLeagueInterface;
};

/// Feeds a vision node with what comes from the league's multicast, and says on stderr what is wrong with it.
/// The bus must not call back any more when this has gone. Throws as MulticastReceiver and LeagueSource do.
class LeagueInput {
 public:
  LeagueInput(DdsBus& bus, const Scenario& scenario, const LeagueAddress& from, VisionNode& to);
  LeagueInput(const LeagueInput&) = delete;
  LeagueInput& operator=(const LeagueInput&) = delete;

 private:
  void take(std::span<const std::byte> datagram, const league::Endpoint& from);
  void report_silence();
  void report_refusal(const league::Endpoint& from);
  void report_field();

  DdsBus& bus_;
  LeagueAddress address_;
  Field field_;
  VisionNode& node_;
  LeagueSource source_;
  league::MulticastReceiver receiver_;
  std::uint64_t next_report_ = 1;
  bool has_reported_field_ = false;
};

}  // namespace sidestep
