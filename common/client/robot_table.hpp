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

/// What agents and vision have reported about each robot. Messages are untrusted.
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
    std::optional<Time> heard_at{};     ///< when the agent's last report arrived
    std::optional<Time> observed_at{};  ///< capture time by vision's clock
    std::optional<Time> seen_at{};      ///< when the last new observation arrived
  };

  ClientId self_;
  std::map<RobotId, Row> rows_;
};

}  // namespace sidestep::client
