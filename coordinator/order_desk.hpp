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
class OrderDesk {
 public:
  /// `changed`: is called when what the coordinator publishes of its state has changed.
  OrderDesk(Bus& bus, const Scenario& scenario, const CoordinatorIdentity& self, Coordinator& coordinator,
            const EventReporter& events, std::function<void()> changed);
  OrderDesk(const OrderDesk&) = delete;
  OrderDesk& operator=(const OrderDesk&) = delete;

  /// Announces all orders, now and every second.
  void announce_periodically();
  void on_order(const msg::Order& message);
  /// A page of another process's memory, or of its own, which is ignored.
  void on_page(const OrderPage& page);
  /// The state of a robot's order, from its agent.
  void on_report(const OrderReport& report);
  /// A robot of the roster obeys this coordinator's epoch.
  void on_obeyed(RobotId robot);
  /// An agent has been registered: learns whether there may be orders, and tells it those that it lacks.
  void on_registered(const Registration& registration);
  /// Tells all orders again for a process that has just started.
  void repeat();
  /// Completes the memory of orders if that is possible.
  void update_memory();
  /// To be called every heartbeat period.
  void update();
  /// The coordinator has begun an epoch, or stands by.
  void begin_epoch();
  void announce_all();
  /// This process's clock was set back: what it remembers of times is void.
  void forget_times() { announced_at_.reset(); }

  const OrderKeeper& orders() const { return orders_; }
  const DropCounters& drops() const { return drops_; }

 private:
  void answer(ClientId client, OrderNumber number, msg::OrderResult result);
  /// Answers the clients whose orders another process remembers too.
  void confirm();
  void apply_holds();
  /// Applies changes of the orders, and announces them if the coordinator is active. Whether it has announced
  /// any.
  bool apply();
  void announce(std::span<const RememberedOrder> orders, bool have_changed);
  /// Announces again the orders that clients have repeated and no process has confirmed.
  void announce_again();
  /// Tells the orders again while agents have to register: they do so once they have been told all that they
  /// remember.
  void tell_registering_agents();

  Bus& bus_;
  const CoordinatorIdentity self_;
  Coordinator& coordinator_;
  const EventReporter& events_;
  std::function<void()> changed_;
  OrderKeeper orders_;
  OrderConfirmations confirmations_;
  OrderBook unheard_;         // orders to be announced again
  bool has_history_ = false;  // in this epoch, a robot has registered that may have been given orders before
  std::optional<Time> announced_at_;  // all of them
  bool has_learned_ = false;          // since then, from another process
  Writer<msg::OrderAnswer> answer_writer_;
  Writer<msg::OrderMemory> memory_writer_;
  DropCounters drops_;
};

}  // namespace sidestep
