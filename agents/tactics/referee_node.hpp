// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "agents/tactics/referee_rules.hpp"
#include "agents/tactics/referee_stream.hpp"
#include "common/client/order_client.hpp"
#include "common/config/scenario.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/time/rate_limit.hpp"

namespace sidestep {

/// Turns the referee's commands into orders to all robots. HALT is ordered immediately, and all other demands
/// once per kPeriod, so packets cannot cause a flood of orders. Without packets, the last packet's demands
/// stay in force, and the zone around the ball still follows the ball. If the ball is lost, the zone stays
/// where the ball was last seen.
class RefereeNode {
 public:
  RefereeNode(Bus& bus, const Scenario& scenario, const RefereeSettings& settings);
  RefereeNode(const RefereeNode&) = delete;
  RefereeNode& operator=(const RefereeNode&) = delete;

  /// Processes an untrusted datagram.
  void on_datagram(std::span<const std::byte> bytes, const league::Endpoint& from);
  /// Sets a callback for events of level `min_level` or higher.
  void on_event(LogLevel min_level, OnLogEvent listener) {
    events_.set_listener(min_level, std::move(listener));
  }

  static constexpr Duration kPeriod{50'000'000};
  /// Silence of the referee after which the log reports it.
  static constexpr Duration kSilenceTimeout{2'000'000'000};

 private:
  void on_world_state(const msg::WorldState& world);
  void update_periodically();
  void report_silence();
  /// Sends orders for all demands that differ from the last orders.
  void update();
  void update_zone(std::uint32_t number, const RefereeDemands& demands);
  void warn(Time now, const std::string& text);

  Bus& bus_;
  RefereeRules rules_;
  RefereeStream stream_;
  OrderClient client_;
  std::optional<league::RefereePacket> packet_;  ///< the last accepted packet
  std::optional<BallState> ball_;
  std::optional<bool> is_held_;                         ///< as last ordered; nullopt: nothing was ordered
  std::map<std::uint32_t, std::optional<Zone>> zones_;  ///< as last ordered; nullopt: removed
  Time heard_at_;                                       ///< time of the last packet, or of the start
  bool is_silent_ = false;
  RateLimit warnings_{5, std::chrono::seconds(10)};
  EventReporter events_;
};

}  // namespace sidestep
