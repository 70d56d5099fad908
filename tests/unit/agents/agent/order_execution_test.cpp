// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/order_execution.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::order_execution_test {

using namespace std::chrono_literals;

constexpr Time kNow = Time{} + 5s;
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);

Scenario two_goals() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 3, team: blue, start_m: [0, 0], heading_rad: 0.5, goals_m: [[1, 0], [1, 1, 1.5]]}\n",
      "two-goals.yaml");
}

/// A coordinator's complete memory, which contains only the scenario's order for the robot.
std::shared_ptr<OrderPage> scenario_orders() {
  const RememberedOrder order{{msg::OrderKind::ORDER_GO, 3, static_cast<ClientId>(Sender::kScenario), 1}};
  return std::make_shared<OrderPage>(OrderPage{kCoordinator, true, 0, 1, {order}});
}

struct OrderedRobot {
  Scenario scenario = two_goals();
  OrderExecution orders{scenario, scenario.robots[0]};

  bool rests_at(const Vec2& position) {
    return orders.on_execution(Trajectory::resting(kNow, position), kNow);
  }
};

TEST_CASE("the first page of orders changes the goal, and repeating the page does not") {
  OrderedRobot robot;
  CHECK(robot.orders.desired_heading_rad() == 0.5);
  CHECK_FALSE(robot.rests_at({1, 0}));
  const OrderExecution::Changes first = robot.orders.on_page(scenario_orders());
  CHECK(first.goal);
  CHECK_FALSE(first.zones);
  CHECK_FALSE(robot.orders.on_page(scenario_orders()).goal);
  CHECK_FALSE(robot.orders.choose());
}

TEST_CASE(
    "a robot that rests within the tolerance of a goal continues to its next goal or has arrived at its last "
    "goal") {
  OrderedRobot robot;
  (void)robot.orders.on_page(scenario_orders());
  const double tolerance_m = robot.scenario.goal_tolerance_m;
  CHECK_FALSE(robot.rests_at({1 - 1.01 * tolerance_m, 0}));
  CHECK(robot.rests_at({1 - 0.99 * tolerance_m, 0}));
  CHECK(robot.orders.assignment().goal_index() == 1);
  CHECK(robot.orders.desired_heading_rad() == 1.5);
  CHECK_FALSE(robot.orders.has_arrived());
  CHECK_FALSE(robot.rests_at({1, 1}));
  CHECK(robot.orders.has_arrived());
  robot.orders.on_absence();
  CHECK_FALSE(robot.orders.has_arrived());
}

TEST_CASE("a robot does not count as arrived until it is at rest") {
  OrderedRobot robot;
  (void)robot.orders.on_page(scenario_orders());
  Trajectory braking(kNow, {{1, 0}, {0.1, 0}});
  braking.append(1s, {-0.1, 0});
  CHECK_FALSE(robot.orders.on_execution(braking, kNow + 999ms));
  CHECK(robot.orders.assignment().goal_index() == 0);
}

TEST_CASE("only the coordinator in charge of the epoch can announce all orders") {
  OrderedRobot robot;
  CHECK(robot.orders.coordinator_knows_all_orders(7));
  (void)robot.orders.on_page(scenario_orders());
  CHECK_FALSE(robot.orders.coordinator_knows_all_orders(7));
  CoordinatorHeartbeat heartbeat;
  heartbeat.sender = kCoordinator;
  heartbeat.epoch = 7;
  robot.orders.on_heartbeat(heartbeat);
  CHECK(robot.orders.coordinator_knows_all_orders(7));
  CHECK_FALSE(robot.orders.coordinator_knows_all_orders(8));
  heartbeat.incarnation = 5;
  robot.orders.on_heartbeat(heartbeat);
  CHECK_FALSE(robot.orders.coordinator_knows_all_orders(7));
}

}  // namespace sidestep::order_execution_test
