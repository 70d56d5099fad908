// SPDX-License-Identifier: Apache-2.0
#include "coordinator/order_confirmations.hpp"

#include "tests/catch.hpp"

namespace sidestep::order_confirmations_test {

constexpr ClientId kClient = 1'000'001;

struct Floor {
  OrderBook book;
  OrderConfirmations confirmations;
  OrderNumber number = 0;

  Order hold(RobotId robot) {
    const Order order{msg::OrderKind::ORDER_HOLD, robot, kClient, ++number};
    book.merge({order});
    confirmations.add(order);
    return order;
  }
  /// Delivers an agent's report, followed by a fact of its robot.
  void report(RobotId robot, bool is_held) {
    OrderReport report;
    report.robot = robot;
    report.is_held = is_held;
    confirmations.on_report(report);
    confirmations.on_obeyed(robot);
  }
  std::size_t confirmed() { return confirmations.take_confirmed(book).size(); }
};

TEST_CASE("a hold is confirmed once, when the robot's agent reports that its robot is held") {
  Floor floor;
  floor.report(3, true);  // held by an earlier order
  floor.hold(3);
  CHECK(floor.confirmed() == 0);
  floor.report(4, true);
  floor.report(3, false);
  CHECK(floor.confirmed() == 0);
  floor.report(3, true);
  CHECK(floor.confirmed() == 1);
  CHECK(floor.confirmed() == 0);
}

TEST_CASE("a hold of all robots is confirmed when any robot's agent reports that its robot is held") {
  Floor floor;
  floor.hold(kAllRobots);
  floor.report(3, false);
  CHECK(floor.confirmed() == 0);
  floor.report(4, true);
  CHECK(floor.confirmed() == 1);
}

TEST_CASE("an agent's report does not confirm a hold while its robot may obey another coordinator") {
  Floor floor;
  floor.hold(3);
  floor.confirmations.on_obeyed(3);
  OrderReport report;
  report.robot = 3;
  report.is_held = true;
  floor.confirmations.on_report(report);
  CHECK(floor.confirmed() == 0);
  floor.confirmations.on_obeyed(4);
  CHECK(floor.confirmed() == 0);
  floor.confirmations.on_obeyed(3);
  CHECK(floor.confirmed() == 1);
}

TEST_CASE("a hold is not confirmed until an agent of its robots reports that its robot is held") {
  Floor floor;
  floor.hold(3);
  for (int i = 0; i < 100; ++i) {
    floor.report(4, true);
    floor.report(3, false);
    floor.confirmations.on_obeyed(3);
    CHECK(floor.confirmed() == 0);
  }
}

TEST_CASE("a hold that is lifted or replaced before its confirmation is answered as replaced") {
  Floor floor;
  floor.hold(3);
  floor.book.merge({{msg::OrderKind::ORDER_RESUME, 3, kClient, ++floor.number}});
  CHECK(floor.confirmed() == 1);  // the answer says that the hold was replaced
  const Order first = floor.hold(3), last = floor.hold(3);
  const auto replaced = floor.confirmations.take_confirmed(floor.book);
  REQUIRE(replaced.size() == 1);
  CHECK(replaced[0].number == first.number);
  floor.report(3, true);
  const auto confirmed = floor.confirmations.take_confirmed(floor.book);
  REQUIRE(confirmed.size() == 1);
  CHECK(confirmed[0].number == last.number);
}

TEST_CASE("an order other than a hold is confirmed once another process's memory lists it") {
  const auto kind =
      GENERATE(msg::OrderKind::ORDER_GO, msg::OrderKind::ORDER_CANCEL, msg::OrderKind::ORDER_RESUME,
               msg::OrderKind::ORDER_ZONE, msg::OrderKind::ORDER_REMOVE_ZONE);
  CAPTURE(static_cast<int>(kind));
  Floor floor;
  const RobotId robot = kind >= msg::OrderKind::ORDER_ZONE ? kAllRobots : 3;
  const Order order{kind, robot, kClient, 7};
  Order earlier = order, of_other = order;
  earlier.number = 6;
  of_other.client = kClient + 1;
  floor.book.merge({order});
  floor.confirmations.add(order);
  floor.report(3, true);
  CHECK(floor.confirmed() == 0);
  floor.confirmations.on_page({.process = 4, .orders = {{earlier}, {of_other}}});
  CHECK(floor.confirmed() == 0);
  floor.confirmations.on_page({.process = 4, .orders = {{earlier}, {order}}});
  CHECK(floor.confirmed() == 1);
  CHECK(floor.confirmed() == 0);
  CHECK_FALSE(floor.confirmations.is_waiting());
}

TEST_CASE("a memory that lists a hold does not confirm it, because the robot may obey another coordinator") {
  Floor floor;
  const Order hold = floor.hold(3);
  floor.confirmations.on_page({.process = 3, .orders = {{hold}}});
  CHECK(floor.confirmed() == 0);
}

}  // namespace sidestep::order_confirmations_test
