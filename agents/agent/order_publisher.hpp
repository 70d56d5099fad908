// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "agents/agent/agent.hpp"
#include "common/messaging/bus.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// Publishes the agent's knowledge of orders: the orders that coordinators lack, the orders that coordinators
/// have announced, and the progress of its robot's own order.
class OrderPublisher {
 public:
  OrderPublisher(Bus& bus, RobotId robot);

  /// Publishes the agent's reply to a coordinator's page. Precondition: the agent has processed the page.
  void on_page(const OrderPage& page, Agent& agent);
  /// Repeats the orders that coordinators have announced, because coordinators answer a client only once
  /// another process remembers its order.
  void confirm_orders(const Agent& agent);
  /// Publishes the order's status if it has changed, and once a second.
  void publish_status(const Agent& agent);

 private:
  /// Announces orders to the coordinators.
  void publish(std::span<const RememberedOrder> orders, const Agent& agent);
  /// Whether `period` has passed since `since`, by this process's clock.
  bool has_elapsed(Duration period, Time since) const;

  Bus& bus_;
  RobotId robot_;
  Writer<msg::OrderMemory> order_writer_;
  Writer<msg::OrderStatus> status_writer_;
  OrderReport report_;  // as last published
  Time published_at_{}, confirmed_at_{};
  OrderBook announced_;  // announced by coordinators and not repeated yet
};

}  // namespace sidestep
