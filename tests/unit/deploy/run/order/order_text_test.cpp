// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_text.hpp"

#include "tests/catch.hpp"
#include "tests/drawn_text.hpp"

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

TEST_CASE("orders for which nobody waits any longer stay, and the text says how to end them") {
  CHECK(open_orders_text({3}, {}, "") == "robot 3 drives on; `sidestep cancel 3` ends it");
  CHECK(open_orders_text({}, {3}, "bob") ==
        "the order of robot 3 stays in force; `sidestep cancel 3 --client bob` ends it");
  CHECK(
      open_orders_text({1, 2}, {3}, "") ==
      "robots 1, 2 drive on, and the order of robot 3 stays in force; `sidestep cancel ROBOT` ends an order");
  CHECK(open_orders_text({}, {1, 2}, "") ==
        "the orders of robots 1, 2 stay in force; `sidestep cancel ROBOT` ends an order");
  CHECK(open_orders_text({}, {}, "").empty());
}

TEST_CASE("the table names who has ordered a robot, and a robot without an order has none") {
  std::map<RobotId, OrderReport> reports;
  reports[0] = {0, static_cast<ClientId>(Sender::kOperator), 5, {msg::OrderState::ORDER_ARRIVED, 1}};
  reports[1] = {1, 4'000'000'000, 6, {msg::OrderState::ORDER_DRIVING, 0}};
  reports[2] = {2, 0, 0, {}};
  reports[3] = {3, client_id("kitchen"), 7, {msg::OrderState::ORDER_DRIVING, 0}};
  reports[3].client_name = client_name("kitchen");
  CHECK(to_table(reports, {}) ==
        "robot  state     ordered by        goal left s  why\n"
        "    0  arrived   operator             2      -  \n"
        "    1  driving   client 4000000000    1      -  \n"
        "    2  no order  -                    -      -  \n"
        "    3  driving   client kitchen       1      -  \n");
}

TEST_CASE("the table says what hinders a robot, and estimates no time for it") {
  std::map<RobotId, OrderReport> reports;
  for (const RobotId robot : {0u, 1u, 2u, 3u}) {
    reports[robot] = {
        robot, static_cast<ClientId>(Sender::kOperator), 5, {msg::OrderState::ORDER_DRIVING, 0}};
    reports[robot].remaining_s = 1.5;
  }
  reports[2].is_held = true;
  reports[2].blockage = Blockage{msg::BlockReason::BLOCK_ROBOT, 1, Vec2(0, 0), {1, 2}};
  const std::map<RobotId, std::vector<Hindrance>> hindrances{
      {1,
       {{"silent", "it has sent no report", std::chrono::seconds(12)}, {"off floor", "it is off the floor"}}},
      {2, {{"held", "it is held by client bob"}}}};
  CHECK(to_table(reports, hindrances) ==
        "robot  state     ordered by goal left s  why\n"
        "    0  driving   operator      1    1.5  \n"
        "    1  silent    operator      1      -  it has sent no report for 12 s; it is off the floor\n"
        "    2  held      operator      1      -  it is held by client bob; robot 1 stands on its goal; it "
        "goes "
        "to 1.00,2.00 instead\n"
        "    3  driving   operator      1    1.5  \n");
}

TEST_CASE("in a terminal of 60 columns the table shows states and orders, and of the reasons what fits") {
  const int columns = GENERATE(60, 80, 120);
  std::map<RobotId, OrderReport> reports;
  for (const RobotId robot : {0u, 1023u}) {
    reports[robot] = {robot, client_id("kitchen"), 5, {msg::OrderState::ORDER_DRIVING, 0}};
    reports[robot].client_name = client_name("kitchen");
    reports[robot].remaining_s = 1.5;
  }
  const std::string why = "it has sent no report for 12 s; it is off the floor";
  const Screen screen = screen_of(to_table(reports, {{1023, {{"silent", why}}}}), columns);
  CAPTURE(columns);
  INFO(screen.text());
  const std::vector<std::string> lines = screen.lines();
  REQUIRE(lines.size() == 3);
  CHECK(lines[0] == "robot  state     ordered by     goal left s  why");
  CHECK(lines[1] == "    0  driving   client kitchen    1    1.5");
  CHECK_THAT(lines[2], StartsWith(" 1023  silent    client kitchen    1      -  it has sent"));
  CHECK((screen.count(why) == 1) == (columns >= 120));
  CHECK(screen.wraps() == 0);
  CHECK(screen.unknown().empty());
  CHECK(screen.colours() == 0);
}

TEST_CASE("the line of an order says what hinders its robot, until the order is over") {
  Order order{msg::OrderKind::ORDER_GO, 3};
  order.goals.resize(2);
  SentOrder sent{1, order, true, OrderPhase::kDriving};
  const std::vector<Hindrance> lifted{{"off floor", "it is off the floor"}};
  CHECK(to_line(sent) == "go 3: driving to goal 1 of 2");
  CHECK(to_line(sent, lifted) == "go 3: not driving: it is off the floor");
  sent.phase = OrderPhase::kReplaced;
  CHECK(to_line(sent, lifted) == "go 3: replaced by a later order");
}

TEST_CASE("holders are named, and after a resume the robots that they still hold") {
  const auto hold = [](RobotId robot, ClientId client, const char* name = "") {
    Order order{msg::OrderKind::ORDER_HOLD, robot, client, 1};
    order.client_name = client_name(name);
    return order;
  };
  constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);
  constexpr auto kCoordinator = static_cast<ClientId>(Sender::kCoordinator);
  const Order bob = hold(5, client_id("bob"), "bob"), bobs_second = hold(7, client_id("bob"), "bob");
  CHECK(held_text({}) == "it is held");
  CHECK(held_text({bob}) == "it is held by client bob");
  CHECK(held_text({bob, hold(kAllRobots, kOperator), hold(kAllRobots, kCoordinator + 1)}) ==
        "it is held by client bob and coordinator 1 and the operator");
  CHECK(still_held_text({bob}) ==
        "still held: robot 5 by client bob; a hold is ended by its client or by the operator");
  CHECK(
      still_held_text({bob, bobs_second, hold(kAllRobots, kOperator)}) ==
      "still held: robots 5, 7 by client bob, and all robots by the operator; a hold is ended by its client "
      "or by the operator");
}

}  // namespace sidestep::order_text_test
