// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "common/protocol/order.hpp"

namespace sidestep {

/// The orders that hold. Each order has a place; the one with the highest number keeps it:
/// - an order to drive, or its cancellation: one place for each robot and rank;
/// - hold: one for each client and robot (or all robots); resume: likewise;
/// - a zone, or its removal: one for each client and zone number.
/// So books that have merged the same orders hold the same ones, whatever the order of arrival, unless one of
/// them was full.
class OrderBook {
 public:
  enum class Outcome {
    kStored,
    kKnown,     ///< stood there before, with at least this progress
    kReplaced,  ///< a later order stands in its place
    kFull       ///< too many holds or zones
  };

  /// Takes an order, or its progress.
  Outcome merge(const RememberedOrder& order);
  /// What the robot has done with its order of this client and number; the others that it has finished are
  /// left. Whether anything is new.
  bool report(RobotId robot, ClientId client, OrderNumber number, const OrderProgress& progress);

  /// Whether a hold of the robot has not been resumed: by its owner, or by an operator.
  bool is_held(RobotId robot) const;
  /// The robot's order to drive (or its cancellation) of this rank; null: none.
  const RememberedOrder* drive_order(RobotId robot, Rank rank) const;
  /// The order that has the place of this one, or this one itself; null: none.
  const RememberedOrder* in_place_of(const Order& order) const;
  /// The orders of zones that have not been removed.
  std::vector<Order> zones() const;
  std::vector<RememberedOrder> all() const;
  /// The orders that `other` lacks, or knows less of.
  std::vector<RememberedOrder> missing_in(const OrderBook& other) const;
  bool empty() const { return orders_.empty(); }
  /// The highest number of all orders so far; 0: none.
  OrderNumber newest_number() const { return newest_number_; }

  /// Holds and zones that clients can have in a book. Referee and operator can have as many again.
  static constexpr std::size_t kMaxHolds = 256;
  static constexpr std::size_t kMaxZones = 64;

 private:
  enum class Kind : std::uint8_t { kDrive, kHold, kResume, kZone };
  using Place = std::tuple<Kind, RobotId, std::uint32_t, std::uint32_t>;
  static Place place_of(const Order& order);
  bool has_room(const Order& order) const;
  /// Whether the client has lifted its holds of the robot that have this number.
  bool has_resumed(ClientId client, RobotId robot, OrderNumber number) const;

  std::map<Place, RememberedOrder> orders_;
  OrderNumber newest_number_ = 0;
};

}  // namespace sidestep
