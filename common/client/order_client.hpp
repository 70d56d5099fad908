// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/messaging/bus.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// What has become of an order.
enum class OrderPhase : std::uint8_t {
  kSent,      ///< no coordinator has answered yet
  kAccepted,  ///< a coordinator and another process remember it; all but go are complete then
  kDriving,
  kBlocked,   ///< the goal cannot be reached now; the robot goes as near as it can
  kArrived,   ///< at the last goal
  kReplaced,  ///< by a later order; of a hold: lifted
  kRefused
};

constexpr bool is_final(OrderPhase phase) { return phase >= OrderPhase::kArrived; }

/// Identifies an order for its client.
using OrderHandle = std::uint64_t;

/// An order that a client has sent.
struct SentOrder {
  OrderHandle handle = 0;
  Order order;
  /// A coordinator has answered, or it was numbered again because its first number was below those of earlier
  /// orders.
  bool is_number_final = false;
  OrderPhase phase = OrderPhase::kSent;
  msg::OrderResult refusal = msg::OrderResult::RESULT_REMEMBERED;  ///< if it is refused
  std::size_t goal_index = 0;                                      ///< of the goal that the robot drives to
  std::optional<Blockage> blockage{};                              ///< if it is blocked
};

/// Sends orders, repeats them until a coordinator has answered and whenever all coordinators have forgotten
/// them (orders to go, holds and zones as long as they are in force; others while coordinators remember what
/// they have replaced, cancelled, lifted or removed), and follows what becomes of them. If
/// this client's clock is behind those of others, an order is numbered again, above all that the coordinators
/// know: otherwise an earlier order of another client would count as later. That never moves an order behind
/// a later one of this client, nor a resume behind a later hold of anybody.
class OrderClient {
 public:
  OrderClient(Bus& bus, ClientId client);
  OrderClient(const OrderClient&) = delete;
  OrderClient& operator=(const OrderClient&) = delete;

  /// Precondition: at least one goal, at most msg::MAX_ORDER_POSES.
  OrderHandle go(RobotId robot, std::vector<Goal> goals);
  OrderHandle cancel(RobotId robot) { return send({msg::OrderKind::ORDER_CANCEL, robot}); }
  /// `robot` may be kAllRobots.
  OrderHandle hold(RobotId robot) { return send({msg::OrderKind::ORDER_HOLD, robot}); }
  OrderHandle resume(RobotId robot) { return send({msg::OrderKind::ORDER_RESUME, robot}); }
  /// Sets this client's zone of this number. The client forgets its earlier orders about this zone, so that
  /// a zone may move often. Precondition: 1 to kMaxZoneCorners corners.
  OrderHandle zone(std::uint32_t number, Zone zone);
  /// Removes this client's zone of this number, if there is one.
  OrderHandle remove_zone(std::uint32_t number);

  /// nullptr: unknown, or forgotten: because a later order of this client about the same zone was sent, or
  /// because nothing more can become of it and of kMaxFinal others.
  const SentOrder* find(OrderHandle handle) const;
  /// The latest report of each robot.
  const std::map<RobotId, OrderReport>& reports() const { return reports_; }
  /// Calls back whenever the phase or goal of an order has changed.
  void on_change(std::function<void(const SentOrder&)> callback) { on_change_ = std::move(callback); }

  static constexpr std::size_t kMaxFinal = 1000;
  static constexpr Duration kRepetitionPeriod{200'000'000};

 private:
  struct Round {
    std::uint32_t next_page = 0;
    OrderBook book;
  };
  OrderHandle send(Order order);
  OrderHandle send_zone(Order order);
  /// Stops repeating the orders that this one makes meaningless.
  void replace_earlier(const Order& later);
  bool is_followed_by_hold(const SentOrder& resume) const;
  void publish(const Order& order);
  /// nullptr: no order of this client has this number.
  SentOrder* find_number(OrderNumber number);
  /// Numbers the order again if the client's clock is behind, so that the answer says nothing of what the
  /// client wants. Whether it has.
  bool renumber(SentOrder& sent, const msg::OrderAnswer& answer);
  void repeat();
  void on_answer(const msg::OrderAnswer& answer);
  void on_status(const msg::OrderStatus& status);
  void on_memory(const msg::OrderMemory& memory);
  /// Whether enough whole memories in a row lack the order, this one included.
  bool is_forgotten(const SentOrder& sent);
  void compare(const OrderBook& remembered);
  void compare(SentOrder& sent, const OrderBook& remembered);
  void forget(std::map<OrderHandle, SentOrder>::iterator sent);
  void update(SentOrder& sent, OrderPhase phase, std::size_t goal_index);

  Bus& bus_;
  const ClientId client_;
  OrderNumber newest_ = 0;
  OrderHandle last_handle_ = 0;
  std::map<OrderHandle, SentOrder> sent_;
  std::map<OrderNumber, OrderHandle> by_number_;  // current numbers
  std::size_t closed_count_ = 0;
  std::map<OrderHandle, int> missing_;  // whole memories in a row that lack an order that they should have
  std::map<RobotId, OrderReport> reports_;
  std::map<std::uint32_t, Round> rounds_;  // by coordinator
  std::function<void(const SentOrder&)> on_change_;
  Writer<msg::Order> writer_;
};

}  // namespace sidestep
