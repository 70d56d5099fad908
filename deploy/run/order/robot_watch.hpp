// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/client/order_client.hpp"
#include "common/messaging/bus.hpp"
#include "deploy/run/order/hindrance.hpp"

namespace sidestep {

/// Finds out why robots do not carry out their orders, from what robots, agents and coordinators report. With
/// keys, a client other than the operator hears neither robots nor the states of agents, so it learns only
/// who holds a robot, whether its agent is silent, and what coordinators say of it.
class RobotWatch {
 public:
  /// A robot, or an agent, that has sent nothing for longer is silent. Robots report in every control cycle,
  /// and agents once a second.
  static constexpr Duration kRobotSilence{1'000'000'000}, kAgentSilence{3'000'000'000};

  /// `orders` must outlive this object, and this object must outlive the last callback of the bus. With
  /// `has_keys`, a process that hears nobody may be refused by everybody.
  RobotWatch(Bus& bus, const OrderClient& orders, bool has_keys);
  RobotWatch(const RobotWatch&) = delete;
  RobotWatch& operator=(const RobotWatch&) = delete;

  void watch(RobotId robot);
  /// Watches every robot whose agent is heard from now on.
  void watch_all() { watches_all_ = true; }

  /// Empty if nothing is known that hinders the robot, or the robot is not watched.
  std::vector<Hindrance> hindrances(RobotId robot) const;
  /// The hindrances of all watched robots that have any.
  std::map<RobotId, std::vector<Hindrance>> all_hindrances() const;
  /// Whether a watched robot would be found silent, if it is, and its holder is known, if it is held.
  bool is_complete() const;

 private:
  struct Row {
    bool hears_robot = false;  ///< this process may read the robot's reports
    Time heard_at{};           ///< when the robot's last report arrived, or watching began
    bool has_report = false;
    Time agent_heard_at{};  ///< likewise for the agent's reports on orders
    bool is_lifted = false;
    std::optional<msg::AgentState> agent_state{};
    Time agent_state_since{};
  };
  void on_robot_report(RobotId robot, const msg::Feedback& message);
  void on_agent_status(const msg::AgentStatus& status);
  void on_order_status(const msg::OrderStatus& status);
  void on_coordinator_state(const msg::CoordinatorState& state);
  bool is_held(RobotId robot, const std::optional<OrderBook>& remembered) const;
  std::vector<Hindrance> hindrances(RobotId robot, const Row& row,
                                    const std::optional<OrderBook>& remembered) const;
  void add_silences(const Row& row, std::vector<Hindrance>& found) const;
  /// What the active coordinator says of the robot.
  void add_notices(RobotId robot, std::vector<Hindrance>& found) const;
  void add_agent_state(const Row& row, std::vector<Hindrance>& found) const;
  bool is_active_heard() const;

  Bus& bus_;
  const OrderClient& orders_;
  const bool has_keys_;
  Time coordinator_heard_at_;  // when a coordinator was last heard, or watching began
  bool watches_all_ = false;
  std::map<RobotId, Row> rows_;
  msg::CoordinatorState active_;  // the last state of the coordinator that is active in the highest epoch
  std::optional<Time> active_heard_at_;
};

}  // namespace sidestep
