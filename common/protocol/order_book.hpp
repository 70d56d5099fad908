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

/// The orders that are in force. Each order has a place; the order with the highest number keeps it:
/// - an order to drive, or its cancellation: one place per robot and rank;
/// - a hold: one place per client and robot (or all robots); a resume has the same kind of place;
/// - a zone, or its removal: one place per client and zone number.
/// A hold gives up its place once it is lifted, and a resume once a later one lifts everything that it lifts.
/// The number of remembered resumes and removals of clients is bounded: the oldest are forgotten first. So
/// books that have merged the same orders agree, regardless of the order of arrival, unless more than
/// kMaxResumes holds or kMaxRemovals zones have been lifted since. A book that has forgotten a resume may
/// accept the lifted hold again from another process: robots are held rather than released. A resume that
/// releases one robot from a client's hold of all robots is called an exception, and is not forgotten as long
/// as that hold is in force.
class OrderBook {
 public:
  enum class Outcome {
    kStored,
    kKnown,     ///< already in the book with at least this progress, or has no effect
    kReplaced,  ///< a later order has its place, has lifted it or has removed it
    kFull       ///< clients have too many holds, zones or exceptions
  };

  /// Adds an order, or its progress, that another process remembers. Never refuses an order for lack of
  /// space; beyond kMaxMergedExceptions, it forgets the oldest exceptions.
  Outcome merge(const RememberedOrder& order);
  /// Adds an order that a client has sent. Unlike merge(), it limits the number of clients' holds, zones, and
  /// exceptions from holds of all robots. An order that may be a late repetition of a forgotten order counts
  /// as replaced.
  Outcome admit(const Order& order);
  /// Records the robot's progress with its order of this client and number. The robot's other orders in the
  /// state ORDER_ARRIVED become ORDER_LEFT. Progress never goes back. Returns whether anything changed.
  bool report(RobotId robot, ClientId client, OrderNumber number, const OrderProgress& progress);

  /// Whether there is a hold on the robot that neither its owner nor an operator has resumed.
  bool is_held(RobotId robot) const;
  /// The holds on the robot that are in force.
  std::vector<Order> holds_of(RobotId robot) const;
  /// The holds in force, in the order of their robots. Single robots may be excepted from a hold of all
  /// robots.
  std::vector<Order> holds() const;
  /// Whether a resume in the book lifts this hold, for its robot or for all robots.
  bool is_lifted(const Order& hold) const;
  /// Whether the book lacks this order but lists another order that it replaces, cancels, lifts or removes.
  bool contradicts(const Order& order) const;
  /// Whether this order occupies its place.
  bool stands(const Order& order) const;
  /// Whether adding the order, apart from its progress, would change nothing in this book.
  bool knows(const Order& order) const;
  /// The robot's drive order, or its cancellation, of this rank; null if none.
  const RememberedOrder* drive_order(RobotId robot, Rank rank) const;
  /// The order in the place of this order, possibly this order itself; null if none.
  const RememberedOrder* occupant_of(const Order& order) const;
  /// The zones that have not been removed.
  std::vector<Order> zones() const;
  std::vector<RememberedOrder> all() const;
  /// The orders that `other` lacks, or whose progress in `other` is older.
  std::vector<RememberedOrder> missing_in(const OrderBook& other) const;
  bool empty() const { return orders_.empty(); }
  /// Number of holds in force, and of zones that have not been removed.
  std::size_t hold_count() const { return std::accumulate(holds_.begin(), holds_.end(), std::size_t{0}); }
  std::size_t zone_count() const { return std::accumulate(zones_.begin(), zones_.end(), std::size_t{0}); }
  /// The highest order number so far; 0 if none.
  OrderNumber newest_number() const { return newest_number_; }

  /// Maximum number of holds and zones of clients in a book. The referee and the operator can each have the
  /// same number of zones, and a hold for every robot.
  static constexpr std::size_t kMaxHolds = 256;
  static constexpr std::size_t kMaxZones = 64;
  /// Maximum number of clients' resumes, and of zone removals, that a book remembers to recognise late
  /// orders.
  static constexpr std::size_t kMaxResumes = 512;
  static constexpr std::size_t kMaxRemovals = 256;
  /// Maximum number of exceptions from clients' holds of all robots; more than a scenario has robots.
  static constexpr std::size_t kMaxExceptions = 2048, kMaxMergedExceptions = 2 * kMaxExceptions;

 private:
  enum class Kind : std::uint8_t { kDrive, kHold, kResume, kZone };
  using Place = std::tuple<Kind, RobotId, std::uint32_t, std::uint32_t>;
  /// Bounded memory of orders that lift holds or remove zones; the oldest are forgotten first.
  struct Lifted {
    std::set<std::pair<OrderNumber, Place>> by_age;
    OrderNumber forgotten_number = 0;  // highest number of the forgotten orders
  };
  static Place place_of(const Order& order);
  bool has_room(const Order& order) const;
  /// Whether a client's order may be a late repetition of an order that was completely forgotten.
  bool may_be_forgotten(const Order& order) const;
  /// Whether the client has lifted its hold with this number, of this robot or of all robots.
  bool has_resumed(ClientId client, RobotId robot, OrderNumber number) const;
  /// Whether this hold, of the robot or of all robots, holds the robot.
  bool holds_robot(const Order& hold, RobotId robot) const;
  /// Whether a later resume lifts everything that this one lifts.
  bool is_redundant(const Order& resume) const;
  /// Whether the resume ends any hold, at least for one robot.
  bool ends_any_hold(const Order& resume) const;
  /// Whether the resume releases one robot while its client still holds all robots.
  bool is_exception(const Order& resume) const;
  std::size_t exception_count() const;
  void store(const Place& place, const RememberedOrder& order);
  void remove(std::map<Place, RememberedOrder>::iterator entry);
  /// Adds the order to the counts of holds and zones or removes it from them, and remembers its age.
  void count(const Place& place, const Order& order, bool is_added);
  /// Removes holds and resumes that this resume lifts or supersedes.
  void clear_lifted_by(const Order& resume);
  void forget_oldest_resumes();
  void forget_oldest_removals();

  std::map<Place, RememberedOrder> orders_;
  std::array<std::size_t, kRanks> holds_{}, zones_{};  // numbers in force, by rank of the client
  Lifted resumes_, removals_;                          // clients' resumes; removals of zones
  OrderNumber newest_number_ = 0;
};

}  // namespace sidestep
