// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "agents/agent/announced_orders.hpp"
#include "agents/navigation/right_of_way.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// What is known about another robot's orders.
struct OtherAssignment {
  bool is_held = false;
  bool has_drive_order = false;  ///< it has an unfinished order to drive
  OrderNumber number = 0;        ///< number of that order
  std::optional<Vec2> goal_m{};  ///< goal of that order; nullopt if the goal is given by the scenario
};

/// Decides which order a robot carries out: its unfinished order of the highest rank. A robot that has
/// finished its order stays at the goal, and returns there if something moves it away.
class Assignment {
 public:
  /// `scenario_goals` are the robot's goals in the scenario, for orders that name none. Orders of robots that
  /// are not on the roster are ignored; if the roster is empty, all orders are remembered.
  Assignment(RobotId robot, std::vector<Goal> scenario_goals, std::vector<RobotId> roster = {});

  /// Processes orders that a coordinator remembers.
  void on_page(std::shared_ptr<const OrderPage> page);
  /// Records that the robot is at rest at its goal. Precondition: goal() is not null.
  void on_arrival();
  /// Chooses the order to carry out. A finished order remains the robot's order until this call, so that its
  /// completion can be reported.
  void choose();

  /// Whether a coordinator that remembers all orders has been heard. Until then the robot has no orders.
  bool is_known() const { return announced_.is_known(); }
  bool is_held() const { return is_held_; }
  /// The current goal; nullptr if the robot has no order.
  const Goal* goal() const { return goals_.empty() ? nullptr : &goals_[progress_.goal_index]; }
  std::size_t goal_index() const { return progress_.goal_index; }
  /// Increases with every change of goal().
  std::uint64_t revision() const { return revision_; }
  /// The remaining goals, starting with goal().
  std::span<const Goal> goals_left() const {
    return std::span(goals_).subspan(std::min(progress_.goal_index, goals_.size()));
  }
  /// The report on the robot's order, without the fields that only the agent can fill in. Number 0: the robot
  /// has no order.
  OrderReport report() const;
  /// The zone orders in force.
  const std::vector<Order>& zones() const { return zones_; }
  /// Increases with every change of zones().
  std::uint64_t zone_revision() const { return zone_revision_; }
  /// What is known about another robot's orders.
  OtherAssignment other(RobotId robot) const;
  /// Whether the other robot goes first where robots cannot pass each other; see other_passes_first().
  bool yields_to(const PassageContender& other, Time t, Duration period) const;

  /// All orders, including those of other robots.
  std::vector<RememberedOrder> all() const { return announced_.with(book_).all(); }
  bool has_no_orders() const { return announced_.is_empty() && book_.empty(); }
  /// See AnnouncedOrders.
  std::vector<RememberedOrder> take_missing() { return announced_.take_missing(); }
  bool has_announced_all_orders(std::uint32_t coordinator, Incarnation incarnation) const {
    return announced_.has_announced_all_orders(coordinator, incarnation);
  }

 private:
  bool concerns(const RememberedOrder& order) const {
    return order.order.robot == robot_ || order.order.robot == kAllRobots;
  }
  void take(const RememberedOrder& order);
  void drop();
  void report_progress();
  /// Whether the order is still in force.
  bool stands() const;

  const RobotId robot_;
  const std::vector<Goal> scenario_goals_;
  OrderBook book_;  // the robot's orders, including orders to all robots
  AnnouncedOrders announced_;
  bool is_held_ = false;
  // The order that the robot carries out, or the last order that it has carried out.
  ClientId client_ = 0;
  ClientName client_name_{};
  OrderNumber number_ = 0;
  std::vector<Goal> goals_;
  OrderProgress progress_;
  std::uint64_t revision_ = 0;
  std::vector<Order> zones_;
  std::uint64_t zone_revision_ = 0;
};

}  // namespace sidestep
