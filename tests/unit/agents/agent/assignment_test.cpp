// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/assignment.hpp"

#include "tests/catch.hpp"

namespace sidestep::assignment_test {

constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);
constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);
constexpr ClientId kClient = 1'000'001;

RememberedOrder go(ClientId client, OrderNumber number, std::vector<Vec2> positions) {
  RememberedOrder order{{msg::OrderKind::ORDER_GO, 3, client, number}};
  for (const Vec2& position : positions) order.order.goals.push_back({position});
  return order;
}
RememberedOrder scenario_order() { return go(static_cast<ClientId>(Sender::kScenario), 1, {}); }
RememberedOrder of_kind(msg::OrderKind kind, ClientId client, OrderNumber number) {
  return {{kind, 3, client, number}};
}

/// A coordinator's complete memory.
OrderPage memory(std::vector<RememberedOrder> orders) {
  return {kCoordinator, true, 0, 1, std::move(orders)};
}
OrderPage change(RememberedOrder order) { return {kCoordinator, true, 0, 0, {std::move(order)}}; }

struct Robot {
  Assignment assignment{3, {{{1, 0}}, {{2, 0}}}};
  void hear(const OrderPage& page) { assignment.on_page(std::make_shared<OrderPage>(page)); }
  double goal_x() const { return assignment.goal() ? assignment.goal()->position_m.x() : 0; }
};

TEST_CASE("a robot knows its orders once it has received a coordinator's complete memory") {
  Robot r;
  CHECK_FALSE(r.assignment.is_known());
  r.hear(change(scenario_order()));
  CHECK_FALSE(r.assignment.is_known());
  OrderPage second = memory({});
  second.index = 1;
  second.count = 2;
  r.hear(second);
  CHECK_FALSE(r.assignment.is_known());
  OrderPage first = memory({scenario_order()});
  first.count = 2;
  r.hear(first);
  r.hear(second);
  CHECK(r.assignment.is_known());
  Robot other;
  OrderPage incomplete = memory({});
  incomplete.is_complete = false;
  other.hear(incomplete);
  CHECK_FALSE(other.assignment.is_known());
  OrderPage of_agent = memory({});
  of_agent.process = 4;
  other.hear(of_agent);
  CHECK_FALSE(other.assignment.is_known());
}

TEST_CASE("a robot visits its goals in order and stays at the last one") {
  Robot r;
  r.hear(memory({scenario_order()}));
  CHECK(r.goal_x() == 1);
  r.assignment.on_arrival();
  CHECK(r.goal_x() == 2);
  CHECK(r.assignment.report().progress.state == msg::OrderState::ORDER_DRIVING);
  r.assignment.on_arrival();
  CHECK(r.goal_x() == 2);
  CHECK(r.assignment.report().progress.state == msg::OrderState::ORDER_ARRIVED);
  const auto revision = r.assignment.revision();
  r.hear(memory({scenario_order()}));  // the coordinator has not heard of the arrival yet
  CHECK(r.assignment.revision() == revision);
  REQUIRE(r.assignment.take_missing().size() == 1);
  CHECK(r.assignment.take_missing().empty());
}

TEST_CASE("an order of higher rank takes precedence, and the interrupted order continues afterwards") {
  Robot r;
  r.hear(memory({go(kClient, 10, {{5, 0}, {6, 0}})}));
  r.assignment.on_arrival();
  CHECK(r.goal_x() == 6);
  r.hear(change(go(kOperator, 11, {{7, 0}})));
  CHECK(r.goal_x() == 7);
  r.hear(change(go(kClient, 12, {{8, 0}})));
  CHECK(r.goal_x() == 7);
  r.assignment.on_arrival();
  CHECK(r.assignment.report().progress.state == msg::OrderState::ORDER_ARRIVED);
  r.assignment.choose();
  CHECK(r.goal_x() == 8);
  r.assignment.on_arrival();
  CHECK(r.goal_x() == 8);
  r.hear(change(go(kClient, 10, {{5, 0}})));  // this order arrives late
  CHECK(r.goal_x() == 8);
}

TEST_CASE("a cancel order removes the robot's goal until a new drive order arrives") {
  Robot r;
  r.hear(memory({go(kClient, 10, {{5, 0}})}));
  r.hear(change(of_kind(msg::OrderKind::ORDER_CANCEL, kClient, 11)));
  CHECK_FALSE(r.assignment.goal());
  CHECK(r.assignment.report().number == 0);
  r.hear(change(go(kClient, 12, {{6, 0}})));
  CHECK(r.goal_x() == 6);
  r.hear(change(of_kind(msg::OrderKind::ORDER_CANCEL, kOperator, 13)));
  CHECK(r.goal_x() == 6);  // an operator's cancel does not affect a client's order
}

TEST_CASE("a new agent continues at its predecessor's current goal, and does not repeat finished orders") {
  Robot first;
  first.hear(memory({go(kClient, 10, {{5, 0}, {6, 0}, {7, 0}})}));
  first.assignment.on_arrival();
  Robot second;
  second.hear(memory(first.assignment.all()));
  CHECK(second.goal_x() == 6);
  second.assignment.on_arrival();
  second.assignment.on_arrival();
  Robot third;
  third.hear(memory(second.assignment.all()));
  CHECK(third.goal_x() == 7);  // the robot stays at the goal, or returns to it
  CHECK(third.assignment.report().progress.state == msg::OrderState::ORDER_ARRIVED);
  third.hear(change(go(kOperator, 11, {{8, 0}})));
  third.assignment.on_arrival();
  third.hear(change(of_kind(msg::OrderKind::ORDER_CANCEL, kOperator, 12)));
  CHECK_FALSE(third.assignment.goal());  // the robot does not resume its finished order
}

TEST_CASE("an agent remembers the orders of all robots, even if a coordinator's memory lacks them") {
  const RememberedOrder other{{msg::OrderKind::ORDER_CANCEL, 4, kClient, 20}};
  const RememberedOrder another{{msg::OrderKind::ORDER_CANCEL, 5, kClient, 21}};
  Robot r;
  r.hear(memory({scenario_order(), other}));
  r.hear(change(another));
  CHECK(r.assignment.all().size() == 3);
  r.assignment.on_arrival();
  CHECK(r.assignment.all().front().progress.goal_index == 1);
  r.assignment.take_missing();
  r.hear(memory({scenario_order(), another}));
  CHECK(r.assignment.all().size() == 3);
  const auto missing = r.assignment.take_missing();
  REQUIRE(missing.size() == 2);  // this robot's progress, and another robot's order
  CHECK(missing[1].order.robot == 4);
}

RememberedOrder hold_of(RobotId robot, OrderNumber number) {
  return {{msg::OrderKind::ORDER_HOLD, robot, kClient, number}};
}
OrderPage page_from_process(std::uint32_t process, Incarnation incarnation, OrderPage page) {
  page.process = process;
  page.incarnation = incarnation;
  return page;
}

TEST_CASE("an agent knows whether a coordinator has announced all orders that the agent remembers") {
  constexpr std::uint32_t kActive = kCoordinator, kStandby = kCoordinator + 1;
  Robot r;
  CHECK(r.assignment.has_no_orders());
  r.hear(page_from_process(kActive, 1, memory({hold_of(8, 5)})));
  CHECK_FALSE(r.assignment.has_no_orders());
  CHECK(r.assignment.has_announced_all_orders(kActive, 1));
  CHECK_FALSE(
      r.assignment.has_announced_all_orders(kActive, 2));  // a restarted coordinator has forgotten all orders
  CHECK_FALSE(r.assignment.has_announced_all_orders(kStandby, 1));
  // The standby, which was partitioned from the network, claims that its empty memory is complete.
  r.hear(page_from_process(kStandby, 1, memory({})));
  CHECK_FALSE(r.assignment.has_announced_all_orders(kStandby, 1));
  REQUIRE(r.assignment.take_missing().size() == 1);
  r.hear(page_from_process(kStandby, 1, memory({})));
  CHECK_FALSE(r.assignment.has_announced_all_orders(kStandby, 1));
  CHECK(r.assignment.take_missing().size() == 1);  // the orders are announced again
  r.hear(page_from_process(kStandby, 1, memory({hold_of(8, 5)})));
  CHECK(r.assignment.has_announced_all_orders(kStandby, 1));
  CHECK(r.assignment.take_missing().empty());
  // The standby may not have received a new order that the active coordinator announces.
  r.hear(page_from_process(kActive, 1, change(hold_of(9, 6))));
  CHECK(r.assignment.has_announced_all_orders(kActive, 1));
  CHECK_FALSE(r.assignment.has_announced_all_orders(kStandby, 1));
  r.hear(page_from_process(kActive, 1, memory({hold_of(8, 5), hold_of(9, 6), hold_of(10, 7)})));
  r.hear(page_from_process(kStandby, 1, memory({hold_of(8, 5), hold_of(9, 6)})));
  CHECK_FALSE(r.assignment.has_announced_all_orders(kStandby, 1));
  CHECK(r.assignment.has_announced_all_orders(kActive, 1));
}

TEST_CASE("an agent keeps its orders through a succession of coordinators without any orders") {
  Robot r;
  r.hear(memory({hold_of(8, 5)}));
  for (Incarnation incarnation = 2; incarnation < 10; ++incarnation) {
    OrderPage empty = page_from_process(kCoordinator + static_cast<std::uint32_t>(incarnation % 3),
                                        incarnation, memory({}));
    empty.is_complete = incarnation % 2 == 0;
    r.hear(empty);
    CHECK(r.assignment.take_missing().size() == 1);
    CHECK(r.assignment.all().size() == 1);
    CHECK(r.assignment.other(8).is_held);
  }
}

TEST_CASE("an agent forgets no order, even after thousands of changes since the last complete memory") {
  Robot r;
  r.hear(memory({hold_of(8, 5)}));
  for (OrderNumber number = 100; number < 2000; ++number) {
    RememberedOrder order = go(kClient, number, {{1, 0}});
    order.order.robot = 100 + static_cast<RobotId>(number % 700);
    r.hear(change(order));
  }
  CHECK(r.assignment.all().size() == 701);
  r.hear(memory({}));
  CHECK(r.assignment.take_missing().size() == 701);
}

TEST_CASE("of two robots in a passage, the one with the older order goes first") {
  constexpr Duration kPeriod = std::chrono::seconds(30);
  for (const RobotId older : {RobotId{3}, RobotId{8}}) {
    CAPTURE(older);
    Assignment of_3(3, {}), of_8(8, {});
    RememberedOrder drive_3 = go(kClient, older == 3 ? 10 : 20, {{1, 0}}),
                    drive_8 = go(kClient, older == 8 ? 10 : 20, {{2, 0}});
    drive_8.order.robot = 8;
    for (Assignment* assignment : {&of_3, &of_8})
      assignment->on_page(std::make_shared<OrderPage>(memory({drive_3, drive_8})));
    for (int period = 1; period < 4; ++period) {  // the precedence is random in every fourth period
      const Time t = Time(period * kPeriod + kPeriod / 2);
      CHECK(of_3.yields_to({8, of_3.other(8).number}, t, kPeriod) == (older == 8));
      CHECK(of_8.yields_to({3, of_8.other(3).number}, t, kPeriod) == (older == 3));
    }
  }
}

TEST_CASE("an agent remembers no orders of robots that are not on the roster") {
  Assignment assignment(3, {}, {4, 3});
  assignment.on_page(
      std::make_shared<OrderPage>(memory({hold_of(4, 5), hold_of(9, 6), hold_of(kAllRobots, 7)})));
  CHECK(assignment.all().size() == 2);
}

TEST_CASE("a hold order holds a robot until a resume order lifts the hold") {
  Robot r;
  r.hear(memory({scenario_order(), of_kind(msg::OrderKind::ORDER_HOLD, kClient, 5)}));
  CHECK(r.assignment.is_held());
  r.hear(change(of_kind(msg::OrderKind::ORDER_RESUME, kClient, 6)));
  CHECK_FALSE(r.assignment.is_held());
}

TEST_CASE("zones are remembered until they are removed, and other orders do not count as zone changes") {
  Robot r;
  RememberedOrder zone{{msg::OrderKind::ORDER_ZONE, kAllRobots, kClient, 5}};
  zone.order.zone.corners_m = {{1, 1}};
  r.hear(memory({zone}));
  CHECK(r.assignment.zones().size() == 1);
  const auto revision = r.assignment.zone_revision();
  r.hear(memory({zone, go(kClient, 6, {{4, 0}})}));
  CHECK(r.assignment.zone_revision() == revision);
  r.hear(change({{msg::OrderKind::ORDER_REMOVE_ZONE, kAllRobots, kClient, 7}}));
  CHECK(r.assignment.zones().empty());
  CHECK(r.assignment.zone_revision() > revision);
}

TEST_CASE("an agent knows whether another robot is held, and the current goal of that robot") {
  Robot r;
  const auto of_other = [](RememberedOrder order) {
    order.order.robot = 8;
    return order;
  };
  RememberedOrder drive = of_other(go(kClient, 5, {{4, 0}, {6, 0}}));
  drive.progress = {msg::OrderState::ORDER_DRIVING, 1};
  r.hear(memory({drive, of_kind(msg::OrderKind::ORDER_HOLD, kClient, 6)}));
  CHECK_FALSE(r.assignment.other(8).is_held);
  CHECK(r.assignment.other(8).has_drive_order);
  CHECK(r.assignment.other(8).goal_m == Vec2(6, 0));
  CHECK_FALSE(r.assignment.other(9).has_drive_order);
  r.hear(change(of_other(of_kind(msg::OrderKind::ORDER_HOLD, kOperator, 7))));
  CHECK(r.assignment.other(8).is_held);
  drive.progress.state = msg::OrderState::ORDER_ARRIVED;
  r.hear(change(drive));
  CHECK_FALSE(r.assignment.other(8).has_drive_order);
  r.hear(change(of_other(scenario_order())));
  CHECK(r.assignment.other(8).has_drive_order);
  CHECK_FALSE(r.assignment.other(8).goal_m);
}

}  // namespace sidestep::assignment_test
