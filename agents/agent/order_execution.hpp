// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "agents/agent/assignment.hpp"
#include "common/config/scenario.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// The order that a robot carries out, and its progress. Inputs: the orders that coordinators remember, what
/// the robot executes, and which coordinator is in charge. Outputs: the goal, the heading, whether the robot
/// has arrived, and whether the coordinator in charge knows all orders.
class OrderExecution {
 public:
  /// The changes that a page of orders has made for the robot.
  struct Changes {
    bool goal = false;
    bool zones = false;
  };

  OrderExecution(const FloorSpec& floor, const RobotSpec& robot);

  /// Processes orders that a coordinator remembers.
  Changes on_page(std::shared_ptr<const OrderPage> page);
  /// Checks whether the robot, which executes `executing`, is at its goal at time `at`. If so, continues with
  /// the next goal. Returns whether the goal has changed.
  bool on_execution(const Trajectory& executing, Time at);
  /// Records that the robot is off the floor.
  void on_absence() { has_arrived_ = false; }
  /// Processes a heartbeat of the active coordinator in the agent's epoch.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat);
  /// Starts the next order if the robot has finished its order. Returns whether the goal has changed.
  bool choose();
  /// See Assignment.
  std::vector<RememberedOrder> take_missing() { return assignment_.take_missing(); }

  const Assignment& assignment() const { return assignment_; }
  /// Whether the robot is at rest at its last goal.
  bool has_arrived() const { return has_arrived_; }
  double desired_heading_rad() const { return desired_heading_rad_; }
  /// Whether the coordinator that is active in this epoch has announced all orders that are remembered here.
  bool coordinator_knows_all_orders(Epoch epoch) const;

 private:
  /// The active coordinator from which the last heartbeat arrived.
  struct CoordinatorInCharge {
    std::uint32_t coordinator = 0;
    Incarnation incarnation = 0;
    Epoch epoch = 0;
  };
  /// Starts a new goal if the goal has changed since this revision of the assignment. Returns whether it has
  /// changed.
  bool begin_if_changed(std::uint64_t revision);

  double goal_tolerance_m_;
  double start_heading_rad_;
  Assignment assignment_;
  CoordinatorInCharge in_charge_;
  double desired_heading_rad_;
  bool has_arrived_ = false;
};

}  // namespace sidestep
