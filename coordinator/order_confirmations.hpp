// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// Accepted orders whose clients have not been answered yet. An order is confirmed once another process
/// remembers it and it therefore survives the death of this process. Until then the client gets no answer and
/// repeats the order, also to the next coordinator.
/// - Most orders are confirmed when an agent or another coordinator lists them in its memory.
/// - A hold is confirmed once the agent of one of its robots has reported that the robot is held, and the
/// robot has afterwards reported that it obeys this coordinator. This proves that the agent remembered the
/// hold before it registered with any later coordinator. So a coordinator that takes over learns of the hold,
/// even if this coordinator was cut off.
class OrderConfirmations {
 public:
  /// Adds an order that is in force in the order book.
  void add(const Order& order);
  /// Processes a page of another process's memory.
  void on_page(const OrderPage& page);
  void on_report(const OrderReport& report);
  /// Processes a fact from a robot that obeys this coordinator's epoch.
  void on_obeyed(RobotId robot);
  /// Removes and returns the orders that are confirmed or no longer in the book; each is returned once.
  std::vector<Order> take_confirmed(const OrderBook& book);
  void clear() { waiting_.clear(); }
  bool is_waiting() const { return !waiting_.empty(); }

 private:
  struct Waiting {
    Order order;
    std::set<RobotId> remembered_by{};  // for a hold: the robots on the roster whose agents remember it
    bool is_confirmed = false;
  };

  std::map<std::pair<ClientId, OrderNumber>, Waiting> waiting_;
};

}  // namespace sidestep
