// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// The orders that coordinators have announced, and which coordinators have announced all of them. They
/// include the orders of other robots, whose agents may have forgotten them in a restart together with all
/// coordinators. An order that a coordinator's memory lacks is kept, because that coordinator may have been
/// cut off from the network. `own` are the robot's orders with its latest progress.
class AnnouncedOrders {
 public:
  /// Orders of robots that are not on the roster are ignored; if the roster is empty, all are remembered.
  explicit AnnouncedOrders(std::vector<RobotId> roster);

  /// Processes orders that a coordinator remembers.
  void on_page(std::shared_ptr<const OrderPage> page, const OrderBook& own);
  /// Records that the robot has progressed since the last memory of a coordinator arrived.
  void on_progress() { has_progressed_ = true; }

  /// Whether a coordinator that remembers all orders has been heard.
  bool is_known() const { return is_known_; }
  bool is_empty() const { return latest_memory_.empty() && changes_.empty(); }
  /// All orders, including `own`.
  OrderBook with(const OrderBook& own) const;
  /// The announced orders to one robot, including orders to all robots.
  OrderBook of(RobotId robot) const;
  /// Removes and returns the orders of all robots that were missing in the latest memory received from a
  /// coordinator.
  std::vector<RememberedOrder> take_missing() { return std::exchange(missing_, {}); }
  /// Whether the coordinator process with this incarnation has announced every order that is remembered here.
  /// A running coordinator forgets no order.
  bool has_announced_all_orders(std::uint32_t coordinator, Incarnation incarnation) const;

 private:
  using Round = std::vector<std::shared_ptr<const OrderPage>>;
  bool is_on_roster(const Order& order) const;
  /// Adds a page of a coordinator's complete memory.
  void add(std::shared_ptr<const OrderPage> page, const OrderBook& own);
  void add_changes(std::shared_ptr<const OrderPage> page, const OrderBook& own);
  /// Compares a coordinator's complete memory with the orders remembered here.
  void compare(const Round& round, const OrderBook& own);
  template <typename Use>
  void for_each(Use use) const;

  std::vector<RobotId> roster_;  // robot numbers, ascending
  bool is_known_ = false;
  Round latest_memory_;                    // the latest complete memory of a coordinator
  Round changes_;                          // orders that latest_memory_ lacks, and later changes
  bool has_progressed_ = false;            // whether the robot has progressed since latest_memory_ arrived
  std::map<std::uint32_t, Round> rounds_;  // by coordinator: memories whose pages are still arriving
  std::map<std::uint32_t, Incarnation> fully_announced_by_;  // see has_announced_all_orders()
  std::vector<RememberedOrder> missing_;
};

}  // namespace sidestep
