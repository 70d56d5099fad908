// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/messaging/bus.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// The state of an order.
enum class OrderPhase : std::uint8_t {
  kSent,      ///< no coordinator has answered yet
  kAccepted,  ///< a coordinator and another process remember it; every order except `go` is then complete
  kDriving,
  kBlocked,   ///< the goal cannot be reached now; the robot waits as near as it can
  kArrived,   ///< the robot is at its last goal
  kReplaced,  ///< a later order has replaced it; for a hold: it has been lifted
  kRefused
};

constexpr bool is_final(OrderPhase phase) { return phase >= OrderPhase::kArrived; }

/// Identifies an order within its client.
using OrderHandle = std::uint64_t;

/// An order that a client has sent.
struct SentOrder {
  OrderHandle handle = 0;
  Order order;
  /// The number will not change again: a coordinator has answered, or the order was renumbered because its
  /// first number was below those of earlier orders.
  bool is_number_final = false;
  OrderPhase phase = OrderPhase::kSent;
  msg::OrderResult refusal = msg::OrderResult::RESULT_REMEMBERED;  ///< reason, if the order was refused
  std::size_t goal_index = 0;                                      ///< index of the robot's current goal
  std::optional<Blockage> blockage{};                              ///< cause, if the robot is blocked
};

/// Sends orders and tracks their state. An order is repeated until a coordinator has answered, and whenever a
/// coordinator has forgotten it. Drive orders, holds and zones are kept alive while they are in force. Other
/// orders are kept alive while coordinators remember the orders that they replaced, cancelled, lifted or
/// removed. If this client's clock is behind other clients' clocks, an order is renumbered above every number
/// that the coordinators know; otherwise an earlier order of another client would count as later. Renumbering
/// never moves an order behind a later one of this client, nor a resume behind a later hold by any client.
class OrderClient {
 public:
  /// Orders carry the name, for people. It is empty, or the one from which the client's id is made.
  OrderClient(Bus& bus, ClientId client, std::string_view name = {});
  OrderClient(const OrderClient&) = delete;
  OrderClient& operator=(const OrderClient&) = delete;

  /// Precondition: at least one goal and at most msg::MAX_ORDER_POSES.
  OrderHandle go(RobotId robot, std::vector<Goal> goals);
  OrderHandle cancel(RobotId robot) { return send({msg::OrderKind::ORDER_CANCEL, robot}); }
  /// `robot` may be kAllRobots.
  OrderHandle hold(RobotId robot) { return send({msg::OrderKind::ORDER_HOLD, robot}); }
  OrderHandle resume(RobotId robot) { return send({msg::OrderKind::ORDER_RESUME, robot}); }
  /// Sets this client's zone with this number. The client forgets its earlier orders about this zone, so that
  /// a zone may move often. Precondition: 1 to kMaxZoneCorners corners.
  OrderHandle zone(std::uint32_t number, Zone zone);
  /// Removes this client's zone with this number, if there is one.
  OrderHandle remove_zone(std::uint32_t number);

  /// nullptr if the order is unknown or forgotten. An order is forgotten when this client sends a later order
  /// about the same zone, or when it and kMaxFinal others are final.
  const SentOrder* find(OrderHandle handle) const;
  /// The latest report of each robot.
  const std::map<RobotId, OrderReport>& reports() const { return reports_; }
  /// The orders in the latest complete memories of coordinators, and those that these have announced since;
  /// nullopt if no complete memory was received yet. Leaves out coordinators that no longer repeat their
  /// memories while another one does: they have died, and orders in their memories may have ended since.
  std::optional<OrderBook> remembered_orders() const;
  /// Whether this coordinator has told its complete memory.
  bool has_memory_of(std::uint32_t coordinator) const { return memories_.contains(coordinator); }
  /// Whether this client has set this zone, coordinators remember that it did, or none has told its memory
  /// yet.
  bool may_have_zone(std::uint32_t number) const;
  /// Calls back whenever the phase or goal of an order has changed.
  void on_change(std::function<void(const SentOrder&)> callback) { on_change_ = std::move(callback); }

  static constexpr std::size_t kMaxFinal = 1000;
  static constexpr Duration kRepetitionPeriod{200'000'000};
  /// A coordinator whose memory is older than that of another one by more than this has died. Coordinators
  /// repeat their memories once a second.
  static constexpr Duration kMaxMemoryLag{3'000'000'000};

 private:
  struct Round {
    std::uint32_t next_page = 0;
    OrderBook book;
  };
  struct Memory {
    OrderBook book;
    Time heard_at{};  ///< when its last complete repetition arrived
  };
  OrderHandle send(Order order);
  OrderHandle send_zone(Order order);
  /// Marks earlier orders that `later` supersedes as replaced, so that they are not repeated.
  void replace_earlier(const Order& later);
  bool is_followed_by_hold(const SentOrder& resume) const;
  void publish(const Order& order);
  /// nullptr if this client has no order with this number.
  SentOrder* find_number(OrderNumber number);
  /// Renumbers the order if this client's clock is behind and the number was therefore too low: the
  /// coordinator then took an earlier order for a later one. Returns whether it renumbered the order.
  bool renumber(SentOrder& sent, const msg::OrderAnswer& answer);
  void repeat();
  void on_answer(const msg::OrderAnswer& answer);
  void on_status(const msg::OrderStatus& status);
  void on_memory(const msg::OrderMemory& memory);
  /// Counts another consecutive complete order memory of this coordinator that lacks the order. Returns true
  /// at every kRoundsUntilForgotten-th one.
  bool count_lacking_memory(const SentOrder& sent, std::uint32_t coordinator);
  /// Whether the latest complete order memory of any coordinator lists the order.
  bool is_listed(const SentOrder& sent) const;
  void compare(std::uint32_t coordinator, const OrderBook& remembered);
  void compare(SentOrder& sent, std::uint32_t coordinator, const OrderBook& remembered);
  void forget(std::map<OrderHandle, SentOrder>::iterator sent);
  void update(SentOrder& sent, OrderPhase phase, std::size_t goal_index);

  Bus& bus_;
  const ClientId client_;
  const ClientName name_;
  OrderNumber newest_ = 0;
  OrderHandle last_handle_ = 0;
  std::map<OrderHandle, SentOrder> sent_;
  std::map<OrderNumber, OrderHandle> by_number_;  // keyed by the orders' current numbers
  std::size_t closed_count_ = 0;
  /// Number of consecutive complete order memories of each coordinator that lack the order.
  std::map<OrderHandle, std::map<std::uint32_t, int>> missing_;
  std::map<RobotId, OrderReport> reports_;
  std::map<std::uint32_t, Round> rounds_;     // keyed by coordinator
  std::map<std::uint32_t, Memory> memories_;  // the last complete memory of each coordinator
  std::function<void(const SentOrder&)> on_change_;
  Writer<msg::Order> writer_;
};

}  // namespace sidestep
