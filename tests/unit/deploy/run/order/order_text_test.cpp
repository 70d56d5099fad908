// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_text.hpp"

#include "tests/catch.hpp"

namespace sidestep::order_text_test {

TEST_CASE("an order is described by its robot and a zone by its number") {
  const auto line = [](msg::OrderKind kind, RobotId robot) {
    Order order{kind, robot};
    order.zone_number = 7;
    return to_line({1, order, false, OrderPhase::kAccepted});
  };
  CHECK(line(msg::OrderKind::ORDER_CANCEL, 3) == "cancel 3: accepted");
  CHECK(line(msg::OrderKind::ORDER_HOLD, kAllRobots) == "hold all: accepted");
  CHECK(line(msg::OrderKind::ORDER_ZONE, kAllRobots) == "zone 7: accepted");
  CHECK(line(msg::OrderKind::ORDER_REMOVE_ZONE, kAllRobots) == "remove zone 7: accepted");
}

TEST_CASE("a zone that is not there cannot be removed, and the zones that are there are named") {
  constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);
  CHECK(unknown_zone_text(7, kOperator, {}, {}) ==
        "remove zone 7: refused, the operator has no zone 7; there are no zones");
  const auto zone = [](ClientId client, std::uint32_t number, const char* name = "") {
    Order order{msg::OrderKind::ORDER_ZONE, kAllRobots, client, 1};
    order.zone_number = number;
    order.client_name = client_name(name);
    return order;
  };
  // Two coordinators list the same zone.
  CHECK(
      unknown_zone_text(7, client_id("bob"), client_name("bob"),
                        {zone(kOperator, 1), zone(client_id("kitchen"), 7, "kitchen"), zone(2'000'001, 8),
                         zone(kOperator, 1)}) ==
      "remove zone 7: refused, client bob has no zone 7; zones: 1 of the operator, 7 of client kitchen, 8 of "
      "client 2000001");
}

TEST_CASE("the table names who has ordered a robot, and a robot without an order has none") {
  std::map<RobotId, OrderReport> reports;
  reports[0] = {0, static_cast<ClientId>(Sender::kOperator), 5, {msg::OrderState::ORDER_ARRIVED, 1}};
  reports[1] = {1, 4'000'000'000, 6, {msg::OrderState::ORDER_DRIVING, 0}};
  reports[2] = {2, 0, 0, {}};
  reports[3] = {3, client_id("kitchen"), 7, {msg::OrderState::ORDER_DRIVING, 0}};
  reports[3].client_name = client_name("kitchen");
  CHECK(to_table(reports) ==
        "robot  state     ordered by        goal left s  why\n"
        "    0  arrived   operator             2      -  \n"
        "    1  driving   client 4000000000    1      -  \n"
        "    2  no order  -                    -      -  \n"
        "    3  driving   client kitchen       1      -  \n");
}

}  // namespace sidestep::order_text_test
