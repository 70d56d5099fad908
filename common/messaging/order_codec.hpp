// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/protocol/order.hpp"

namespace sidestep {

/// Maximum number of pages; more than needed for the orders of kMaxRobots robots, all holds and all zones.
inline constexpr std::uint32_t kMaxOrderPages = 512;

/// Codecs refuse zones with more corners.
inline constexpr std::size_t kMaxZoneCorners = 16;
/// Codecs refuse lower speed limits, at which a robot would hardly move.
inline constexpr double kMinSpeedLimit_mps = 0.01;
/// Codecs refuse smaller or larger arrival tolerances.
inline constexpr double kMinTolerance_m = 0.001, kMaxTolerance_m = 10;

/// A page of the orders that a process remembers; see OrderMemory in idl/order.idl.
struct OrderPage {
  std::uint32_t process = 0;
  bool is_complete = false;
  std::uint32_t index = 0;
  std::uint32_t count = 0;  ///< number of the sender's pages; 0: the page lists only orders that have changed
  std::vector<RememberedOrder> orders;
  Incarnation incarnation = 0;  ///< incarnation of the sending process
};

/// Whether two pages list the same orders with the same progress.
[[nodiscard]] bool have_same_orders(const OrderPage& a, const OrderPage& b);

/// An agent's report on its robot's order; see OrderStatus in idl/order.idl.
struct OrderReport {
  RobotId robot = 0;
  ClientId client = 0;
  OrderNumber number = 0;  ///< 0: the robot has no order
  OrderProgress progress{};
  bool is_held = false;
  std::optional<Blockage> blockage{};  ///< set if the goal cannot be reached now
  std::optional<double> remaining_s{};
  ClientName client_name{};
};

/// Decodes an untrusted order. Returns nullopt if the sender may not send this order, if the kind is unknown,
/// if the number is implausible at `now` (by the local clock), or if any value is out of bounds.
[[nodiscard]] std::optional<Order> decode(const msg::Order& message, Time now);
/// Decodes an untrusted page. Returns nullopt if its sender is neither a coordinator nor an agent, if there
/// are more than kMaxOrderPages pages, or if any of its orders is invalid.
[[nodiscard]] std::optional<OrderPage> decode(const msg::OrderMemory& message, Time now);
/// Decodes an untrusted status. Returns nullopt if the sender is not an agent of its robot, or if any value
/// is unknown or out of bounds.
[[nodiscard]] std::optional<OrderReport> decode(const msg::OrderStatus& message);

/// Encodes an order without the header's incarnation, message_number and stamp_ns.
msg::Order encode(const Order& order);
/// Encodes a status without its header.
msg::OrderStatus encode(const OrderReport& report);
/// Encodes orders on as many pages as they need, at least one, without headers. If the list contains only
/// changed orders, page_count is 0.
std::vector<msg::OrderMemory> encode(std::span<const RememberedOrder> orders, bool is_complete,
                                     bool have_changed);

}  // namespace sidestep
