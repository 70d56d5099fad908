// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include "common/client/client.hpp"
#include "common/protocol/order.hpp"
#include "common/time/time.hpp"
#include "idl/order.hpp"
#include "idl/vision.hpp"

namespace sidestep::client {

/// The latest reports of agents and vision about each robot. Messages are untrusted.
class RobotTable {
 public:
  /// Agents report at least once a second.
  static constexpr Duration kStatusTimeout = std::chrono::seconds(3);
  static constexpr Duration kPoseTimeout = std::chrono::seconds(1);

  explicit RobotTable(ClientId self) : self_(self) {}

  void on_status(const msg::OrderStatus& status, Time now);
  void on_world_state(const msg::WorldState& world, Time now);
  /// All robots, sorted by number.
  std::vector<Robot> robots(Time now) const;

 private:
  struct Row {
    Robot robot;
    std::optional<Time> heard_at{};     ///< arrival time of the agent's last report
    std::optional<Time> observed_at{};  ///< capture time by vision's clock
    std::optional<Time> seen_at{};      ///< arrival time of the last new observation
  };

  ClientId self_;
  std::map<RobotId, Row> rows_;
};

}  // namespace sidestep::client
