// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// The orders that a coordinator remembers. Until its memory is complete, every robot is held: an order to
/// hold might have been given that it does not know.
class OrderKeeper {
 public:
  /// How long a coordinator that could grant waits for a complete memory, before it holds all robots in its
  /// own name.
  static constexpr Duration kMaxWait{2'000'000'000};
  /// Holds and zones of other processes' memories that have room. Every coordinator admits at most
  /// OrderBook::kMaxHolds and kMaxZones of clients.
  static constexpr std::size_t kMaxMergedHolds = 4 * kMaxRobots;
  static constexpr std::size_t kMaxMergedZones = 3 * kMaxCoordinators * OrderBook::kMaxZones;

  OrderKeeper(const Scenario& scenario, std::uint32_t coordinator_id);

  /// Takes an order of a client, and returns the answer.
  msg::OrderResult on_order(const Order& order);
  /// A page of another process's memory. Returns whether anything is new. No order of it is refused for lack
  /// of room: one that finds none, because somebody fills the memory, holds all robots in this coordinator's
  /// name.
  bool on_page(const OrderPage& page);
  /// An agent has registered. It does so only once this memory holds all orders that it remembers.
  void on_registration(bool agent_knows_orders);
  /// Returns whether anything is new.
  bool on_report(const OrderReport& report);
  /// To be called periodically. `has_history`: a registered robot has ever executed a granted version, or its
  /// agent knows the orders; used only if `is_granting`. Returns whether this completes the memory.
  bool update(bool is_granting, bool has_history, Time now);

  bool is_complete() const { return is_complete_; }
  bool is_held(RobotId robot) const { return !is_complete_ || book_.is_held(robot); }
  const OrderBook& book() const { return book_; }
  /// What has changed since the last call.
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
  std::map<RobotId, bool> has_goals_;  // by robot of the roster: whether the scenario gives it goals
  OrderBook book_;
  std::vector<RememberedOrder> changes_;
  bool is_complete_ = false;
  std::map<std::uint32_t, std::uint32_t>
      next_page_;  // by process: of its complete memory, until one is heard
  std::optional<Time> waiting_since_;
};

}  // namespace sidestep
