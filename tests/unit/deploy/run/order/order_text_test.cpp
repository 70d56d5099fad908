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

}  // namespace sidestep::order_text_test
