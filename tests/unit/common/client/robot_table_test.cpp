// SPDX-License-Identifier: Apache-2.0
#include "common/client/robot_table.hpp"

#include <chrono>
#include <limits>

#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"

namespace sidestep::client::robot_table_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr ClientId kSelf = 1'000'001, kOther = 1'000'002;
constexpr Time kBegin{seconds(1'700'000'000)};

msg::OrderStatus status_of(RobotId robot) {
  msg::OrderStatus status;
  status.robot(robot);
  status.header().sender(robot);
  return status;
}

msg::OrderStatus status_of(RobotId robot, ClientId client, msg::OrderState state) {
  msg::OrderStatus status = status_of(robot);
  status.client(client);
  status.order_number(17);
  status.order_state(state);
  return status;
}

msg::WorldState world_with(RobotId robot, double x_m, Time observed_at) {
  msg::TrackedRobot tracked;
  tracked.robot(robot);
  tracked.observed_at_ns(to_ns(observed_at));
  tracked.observed_x_m(x_m);
  tracked.observed_y_m(2);
  tracked.observed_heading_rad(0.5);
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  world.robots().push_back(tracked);
  return world;
}

TEST_CASE("a robot is free if its agent and vision report it, no hold applies and it has no order") {
  RobotTable table(kSelf);
  CHECK(table.robots(kBegin).empty());
  table.on_status(status_of(3), kBegin);
  REQUIRE(table.robots(kBegin).size() == 1);
  CHECK_FALSE(table.robots(kBegin)[0].is_free());
  table.on_world_state(world_with(3, 1, kBegin), kBegin);
  const Robot robot = table.robots(kBegin)[0];
  CHECK(robot.id == 3);
  CHECK(robot.is_free());
  CHECK(robot.task == TaskState::kNone);
  REQUIRE(robot.pose);
  CHECK(robot.pose->x_m == 1);
  CHECK(robot.pose->y_m == 2);
  CHECK(robot.pose->heading_rad == 0.5);

  msg::OrderStatus held = status_of(3);
  held.is_held(true);
  table.on_status(held, kBegin);
  CHECK_FALSE(table.robots(kBegin)[0].is_free());
}

TEST_CASE("the table shows which client's order a robot carries out and its progress") {
  RobotTable table(kSelf);
  table.on_world_state(world_with(3, 1, kBegin), kBegin);
  const auto after = [&](ClientId client, msg::OrderState state) {
    table.on_status(status_of(3, client, state), kBegin);
    return table.robots(kBegin)[0];
  };
  CHECK(after(kSelf, msg::OrderState::ORDER_ACCEPTED).task == TaskState::kWaiting);
  CHECK(after(kSelf, msg::OrderState::ORDER_DRIVING).task == TaskState::kDriving);
  CHECK(after(kSelf, msg::OrderState::ORDER_DRIVING).has_own_order);
  CHECK_FALSE(after(kOther, msg::OrderState::ORDER_DRIVING).has_own_order);
  CHECK_FALSE(after(kOther, msg::OrderState::ORDER_DRIVING).is_free());
  CHECK(after(kOther, msg::OrderState::ORDER_ARRIVED).is_free());

  msg::OrderStatus blocked = status_of(3, kSelf, msg::OrderState::ORDER_BLOCKED);
  blocked.block_reason(msg::BlockReason::BLOCK_ZONE);
  blocked.remaining_s(4);
  table.on_status(blocked, kBegin);
  CHECK(table.robots(kBegin)[0].task == TaskState::kBlocked);
  CHECK(table.robots(kBegin)[0].remaining_s == 4);
}

TEST_CASE("a robot is not free if its agent has fallen silent or vision has lost it") {
  RobotTable table(kSelf);
  table.on_status(status_of(3), kBegin);
  table.on_world_state(world_with(3, 1, kBegin), kBegin);
  CHECK(table.robots(kBegin + RobotTable::kPoseTimeout)[0].is_free());

  const Time later = kBegin + RobotTable::kPoseTimeout + milliseconds(1);
  table.on_world_state(world_with(3, 1, kBegin), later);  // repeats the same observation
  CHECK(table.robots(later)[0].is_heard);
  CHECK_FALSE(table.robots(later)[0].pose.has_value());

  const Time silent = kBegin + RobotTable::kStatusTimeout + milliseconds(1);
  table.on_world_state(world_with(3, 1, silent), silent);
  CHECK_FALSE(table.robots(silent)[0].is_heard);
  CHECK(table.robots(silent)[0].pose.has_value());
  CHECK_FALSE(table.robots(silent)[0].is_free());
}

TEST_CASE("invalid statuses and world states do not change the table") {
  RobotTable table(kSelf);
  msg::OrderStatus foreign = status_of(3);
  foreign.header().sender(4);
  table.on_status(foreign, kBegin);
  table.on_status(status_of(5000), kBegin);
  table.on_status(status_of(3, kSelf, static_cast<msg::OrderState>(99)), kBegin);

  msg::WorldState of_agent = world_with(3, 1, kBegin);
  of_agent.header().sender(3);
  table.on_world_state(of_agent, kBegin);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  table.on_world_state(world_with(3, kNan, kBegin), kBegin);
  table.on_world_state(world_with(3, 1e9, kBegin), kBegin);
  table.on_world_state(world_with(5000, 1, kBegin), kBegin);
  table.on_world_state(world_with(3, 1, kBegin + std::chrono::hours(2)), kBegin);
  msg::WorldState turned = world_with(3, 1, kBegin);
  turned.robots()[0].observed_heading_rad(kNan);
  table.on_world_state(turned, kBegin);
  CHECK(table.robots(kBegin).empty());
}

}  // namespace sidestep::client::robot_table_test
