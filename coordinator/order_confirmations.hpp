// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// Orders that a client has not been told of yet. An order is confirmed once another process remembers it, so
/// that it survives the death of this one. As long as no such process lives, the client gets no answer, and
/// repeats the order, also to the next coordinator.
/// - Most orders are remembered by an agent, or another coordinator, whose memory lists them.
/// - A hold is confirmed once the agent of a robot that it holds has reported to be held, and the robot after
///   that to obey this coordinator: then this agent has not registered with a later coordinator before it
///   remembered the hold. So a coordinator that takes over learns of it although this one may have been cut
///   off.
class OrderConfirmations {
 public:
  /// An order that stands in the book of orders.
  void add(const Order& order);
  /// A page of another process's memory.
  void on_page(const OrderPage& page);
  void on_report(const OrderReport& report);
  /// A fact of a robot that obeys this coordinator's epoch.
  void on_obeyed(RobotId robot);
  /// The orders that are confirmed, and those that stand in the book no more; each once.
  std::vector<Order> take_confirmed(const OrderBook& book);
  void clear() { waiting_.clear(); }
  bool is_waiting() const { return !waiting_.empty(); }

 private:
  struct Waiting {
    Order order;
    std::set<RobotId> remembered_by{};  // of a hold: agents of robots of the roster
    bool is_confirmed = false;
  };

  std::map<std::pair<ClientId, OrderNumber>, Waiting> waiting_;
};

}  // namespace sidestep
