// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// The orders that a coordinator remembers. Until its memory is complete, every robot is held, because there
/// might be a hold that the coordinator does not know.
class OrderKeeper {
 public:
  /// How long a coordinator that could otherwise grant waits for a complete memory before it holds all robots
  /// in its own name.
  static constexpr Duration kMaxWait{2'000'000'000};
  /// Maximum number of holds and zones taken from other processes' memories. Every coordinator admits at most
  /// OrderBook::kMaxHolds and kMaxZones of clients.
  static constexpr std::size_t kMaxMergedHolds = 4 * kMaxRobots;
  static constexpr std::size_t kMaxMergedZones = 3 * kMaxCoordinators * OrderBook::kMaxZones;

  OrderKeeper(const FloorSpec& floor, std::uint32_t coordinator_id);

  /// Processes an order from a client and returns the answer.
  msg::OrderResult on_order(const Order& order);
  /// Processes a page of another process's memory. Returns whether anything is new. No order on the page is
  /// refused for lack of room: if a flood of orders has filled the memory, all robots are held in this
  /// coordinator's name.
  bool on_page(const OrderPage& page);
  /// Processes a registration. An agent registers only once this memory contains all orders that it
  /// remembers.
  void on_registration(bool agent_knows_orders);
  /// Processes an agent's report on an order. Returns whether anything is new.
  bool on_report(const OrderReport& report);
  /// Must be called periodically. `has_history` means that a registered robot has executed a granted version,
  /// or that its agent knows the orders; it is used only if `is_granting`. Returns whether this call
  /// completes the memory.
  bool update(bool is_granting, bool has_history, Time now);

  bool is_complete() const { return is_complete_; }
  bool is_held(RobotId robot) const { return !is_complete_ || book_.is_held(robot); }
  const OrderBook& book() const { return book_; }
  /// Removes and returns the changes since the last call.
  std::vector<RememberedOrder> take_changes();

 private:
  bool merge(const RememberedOrder& order);
  bool merge_of_other(const RememberedOrder& order);
  bool merge_progress(const RememberedOrder& order);
  /// Holds all robots in this coordinator's name.
  bool hold_all(OrderNumber at_least);
  void complete();
  bool is_known(RobotId robot) const { return robot == kAllRobots || has_goals_.contains(robot); }

  const Field field_;
  const double radius_m_;
  const std::uint32_t id_;
  std::map<RobotId, bool> has_goals_;  // indexed by robot on the roster: whether the scenario gives it goals
  OrderBook book_;
  std::vector<RememberedOrder> changes_;
  bool is_complete_ = false;
  std::map<std::uint32_t, std::uint32_t> next_page_;  // by process, until a complete memory has arrived
  std::optional<Time> waiting_since_;
};

}  // namespace sidestep
