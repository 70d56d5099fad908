// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "common/config/scenario.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "coordinator/coordinator.hpp"
#include "coordinator/failover.hpp"
#include "coordinator/order_confirmations.hpp"
#include "coordinator/order_keeper.hpp"

namespace sidestep {

/// Serves clients for a coordinator: remembers their orders, announces them to the other processes, answers
/// the clients, and holds robots.
class OrderService {
 public:
  /// `changed` is called when the published part of the coordinator's state has changed.
  OrderService(Bus& bus, const FloorSpec& floor, const CoordinatorIdentity& self, Coordinator& coordinator,
               const EventReporter& events, std::function<void()> changed);
  OrderService(const OrderService&) = delete;
  OrderService& operator=(const OrderService&) = delete;

  /// Announces all orders now, and then every second.
  void announce_periodically();
  void on_order(const msg::Order& message);
  /// Processes a page of another process's memory. Ignores this coordinator's own pages.
  void on_page(const OrderPage& page);
  /// Processes the state of a robot's order, as reported by its agent.
  void on_report(const OrderReport& report);
  /// Processes a report that a robot on the roster obeys this coordinator's epoch.
  void on_obeyed(RobotId robot);
  /// Call when an agent has been registered: records whether its robot may have received orders before, and
  /// sends the agent the orders that it lacks.
  void on_registered(const Registration& registration);
  /// Announces all orders again for a process that has just started, unless they were announced very
  /// recently.
  void repeat();
  /// Completes the memory of orders if possible.
  void update_memory();
  /// Must be called once per heartbeat period.
  void update();
  /// Call when the coordinator has begun an epoch or has become a standby.
  void begin_epoch();
  void announce_all();
  /// Call when this process's clock was set back: discards all recorded times.
  void forget_times() { announced_at_.reset(); }

  const OrderKeeper& orders() const { return orders_; }
  const DropCounters& drops() const { return drops_; }

 private:
  void answer(ClientId client, OrderNumber number, msg::OrderResult result);
  /// Answers the clients whose orders another process also remembers.
  void confirm();
  void apply_holds();
  /// Applies changes of the orders, and announces them if the coordinator is active. Returns whether it has
  /// announced any.
  bool apply();
  void announce(std::span<const RememberedOrder> orders, bool have_changed);
  /// Announces again the orders in to_announce_again_, which clients have repeated but no process has
  /// confirmed.
  void announce_again();
  /// Announces the orders repeatedly while agents have yet to register, because each registers only once it
  /// has received all orders that it remembers.
  void announce_to_registering_agents();

  Bus& bus_;
  const CoordinatorIdentity self_;
  Coordinator& coordinator_;
  const EventReporter& events_;
  std::function<void()> changed_;
  OrderKeeper orders_;
  OrderConfirmations confirmations_;
  OrderBook to_announce_again_;       // orders to be announced again
  bool has_history_ = false;          // a robot registered in this epoch may have received orders before
  std::optional<Time> announced_at_;  // when all orders were last announced
  bool has_learned_ = false;          // has learned an order from another process since announced_at_
  Writer<msg::OrderAnswer> answer_writer_;
  Writer<msg::OrderMemory> memory_writer_;
  DropCounters drops_;
};

}  // namespace sidestep
