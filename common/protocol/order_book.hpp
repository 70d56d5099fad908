// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "common/protocol/order.hpp"

namespace sidestep {

/// The orders that hold. Each order has a place; the one with the highest number keeps it:
/// - an order to drive, or its cancellation: one place for each robot and rank;
/// - hold: one for each client and robot (or all robots); resume: likewise;
/// - a zone, or its removal: one for each client and zone number.
/// A hold gives its place back once it is lifted, and a resume once a later one lifts all that it lifts.
/// What remains of clients' resumes and removals is bounded: the oldest ones are forgotten first. So books
/// that have merged the same orders hold the same ones, whatever the order of arrival, unless more than
/// kMaxResumes holds or kMaxRemovals zones have been lifted since. A book that has forgotten a resume may
/// take the lifted hold back from another process: robots are held rather than released. A resume that
/// excepts one robot from a client's hold of all is not forgotten as long as that hold stands.
class OrderBook {
 public:
  enum class Outcome {
    kStored,
    kKnown,     ///< stood there before, with at least this progress; or changes nothing
    kReplaced,  ///< a later order stands in its place, has lifted it or has removed it
    kFull       ///< too many holds, zones or exceptions of clients
  };

  /// Takes an order, or its progress, that another process remembers. Never refuses one for lack of room, but
  /// of more than kMaxMergedExceptions the oldest are forgotten.
  Outcome merge(const RememberedOrder& order);
  /// As merge(), for an order that a client sends. Clients have room for a bounded number of holds, zones,
  /// and exceptions from holds of all robots. An order that may be a late repetition of one that is forgotten
  /// counts as replaced.
  Outcome admit(const Order& order);
  /// What the robot has done with its order of this client and number; the others that it has finished are
  /// left. Whether anything is new.
  bool report(RobotId robot, ClientId client, OrderNumber number, const OrderProgress& progress);

  /// Whether a hold of the robot has not been resumed: by its owner, or by an operator.
  bool is_held(RobotId robot) const;
  /// Whether the book knows that this hold was lifted, for the robot or all robots that it holds.
  bool is_lifted(const Order& hold) const;
  /// Whether the book lacks this order, and lists one that the order replaces, cancels, lifts or removes.
  bool contradicts(const Order& order) const;
  /// Whether this order has its place.
  bool stands(const Order& order) const;
  /// Whether the order, apart from its progress, would change nothing in this book.
  bool knows(const Order& order) const;
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
  /// Holds that stand, and zones that have not been removed.
  std::size_t hold_count() const { return std::accumulate(holds_.begin(), holds_.end(), std::size_t{0}); }
  std::size_t zone_count() const { return std::accumulate(zones_.begin(), zones_.end(), std::size_t{0}); }
  /// The highest number of all orders so far; 0: none.
  OrderNumber newest_number() const { return newest_number_; }

  /// Holds and zones that clients can have in a book. Referee and operator can have as many zones each, and a
  /// hold for every robot.
  static constexpr std::size_t kMaxHolds = 256;
  static constexpr std::size_t kMaxZones = 64;
  /// Resumes of clients, and removals of zones, that a book remembers so that late orders are recognised.
  static constexpr std::size_t kMaxResumes = 512;
  static constexpr std::size_t kMaxRemovals = 256;
  /// Robots that clients can except from their holds of all: more than a scenario has.
  static constexpr std::size_t kMaxExceptions = 2048, kMaxMergedExceptions = 2 * kMaxExceptions;

 private:
  enum class Kind : std::uint8_t { kDrive, kHold, kResume, kZone };
  using Place = std::tuple<Kind, RobotId, std::uint32_t, std::uint32_t>;
  /// What a book remembers of orders that were lifted: the oldest is forgotten first.
  struct Lifted {
    std::set<std::pair<OrderNumber, Place>> by_age;
    OrderNumber forgotten_number = 0;  // highest of those that are forgotten
  };
  static Place place_of(const Order& order);
  bool has_room(const Order& order) const;
  /// Whether a client's order may be a late repetition of one of which nothing remains.
  bool may_be_forgotten(const Order& order) const;
  /// Whether the client has lifted its holds of the robot, or of all, that have this number.
  bool has_resumed(ClientId client, RobotId robot, OrderNumber number) const;
  /// Whether a later resume lifts all that this one lifts.
  bool is_redundant(const Order& resume) const;
  /// Whether a hold stands that the resume ends, or ends for one robot.
  bool lifts_any(const Order& resume) const;
  /// Whether the resume releases one robot of a client that still holds all.
  bool is_exception(const Order& resume) const;
  std::size_t exception_count() const;
  void store(const Place& place, const RememberedOrder& order);
  void remove(std::map<Place, RememberedOrder>::iterator entry);
  /// Adds the order to the counts of holds and zones, or takes it out, and remembers its age.
  void count(const Place& place, const Order& order, bool is_added);
  /// Gives the places back of holds and resumes that the resume makes meaningless.
  void clear_lifted_by(const Order& resume);
  void forget_oldest_resumes();
  void forget_oldest_removals();

  std::map<Place, RememberedOrder> orders_;
  std::array<std::size_t, kRanks> holds_{}, zones_{};  // that stand, by rank of the client
  Lifted resumes_, removals_;                          // resumes of clients; removals of zones
  OrderNumber newest_number_ = 0;
};

}  // namespace sidestep
