// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/motion/goal.hpp"
#include "common/motion/version.hpp"
#include "common/protocol/client_name.hpp"
#include "common/protocol/senders.hpp"
#include "idl/order.hpp"

namespace sidestep {

/// Header.sender of a process that gives orders.
using ClientId = std::uint32_t;
using OrderNumber = std::uint64_t;

/// Value of Order::robot for orders that apply to every robot.
inline constexpr RobotId kAllRobots = msg::ALL_ROBOTS;

/// Priority of clients, ascending. A robot carries out the order of the highest rank first.
enum class Rank : std::uint8_t { kScenario, kClient, kReferee, kOperator };
inline constexpr std::size_t kRanks = 4;

constexpr Rank rank_of(ClientId client) {
  switch (client) {
    case static_cast<ClientId>(Sender::kOperator):
      return Rank::kOperator;
    case static_cast<ClientId>(Sender::kReferee):
      return Rank::kReferee;
    case static_cast<ClientId>(Sender::kScenario):
      return Rank::kScenario;
    default:
      return Rank::kClient;
  }
}

/// A part of the floor: the convex hull of its corners, grown by a radius.
struct Zone {
  std::vector<Vec2> corners_m;  ///< at least one
  double radius_m = 0;
  std::optional<double> speed_limit_mps{};  ///< nullopt: robots must keep out
};

/// An order by a client; see Order in idl/order.idl.
struct Order {
  msg::OrderKind kind = msg::OrderKind::ORDER_GO;
  RobotId robot = 0;
  ClientId client = 0;
  OrderNumber number = 0;
  std::vector<Goal> goals{};  ///< goals of ORDER_GO; empty: the scenario's goals
  std::uint32_t zone_number = 0;
  Zone zone{};  ///< zone of ORDER_ZONE
  ClientName client_name{};
};

/// A robot's progress with a drive order.
struct OrderProgress {
  msg::OrderState state = msg::OrderState::ORDER_ACCEPTED;  ///< never ORDER_BLOCKED, see Blockage
  std::size_t goal_index = 0;                               ///< index of the robot's current goal

  bool is_finished() const { return state >= msg::OrderState::ORDER_ARRIVED; }
};

/// Why a robot cannot reach its goal.
struct Blockage {
  msg::BlockReason reason = msg::BlockReason::BLOCK_NO_PATH;
  std::uint32_t blocker = 0;  ///< number of the blocking robot or zone
  Vec2 blocker_m{0, 0};       ///< position of the blocking obstacle or robot
  Vec2 nearest_m{0, 0};       ///< position that the robot goes to instead; if a stranger blocks it, its own
  double blocker_speed_mps = 0;  ///< maximum speed of a stranger
};

struct RememberedOrder {
  Order order;
  OrderProgress progress{};
};

}  // namespace sidestep
