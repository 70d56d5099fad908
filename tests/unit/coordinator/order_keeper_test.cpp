// SPDX-License-Identifier: Apache-2.0
#include "coordinator/order_keeper.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::order_keeper_test {

constexpr std::uint32_t kSelf = 10000, kOther = 10001;
constexpr ClientId kClient = 1'000'001;
constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);
constexpr Time kNow = time_from_ns(1'000'000'000'000);
constexpr Duration kSecond{1'000'000'000};

Scenario two_robots() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 3, start_m: [0, 0], goals_m: [[1, 0]]}\n  - {id: 4, start_m: [0, 1]}\n",
      "two-robots.yaml");
}

Order go(RobotId robot, OrderNumber number, const Vec2& position) {
  Order order{msg::OrderKind::ORDER_GO, robot, kClient, number};
  order.goals.push_back({position});
  return order;
}
Order of_kind(msg::OrderKind kind, RobotId robot, ClientId client, OrderNumber number) {
  return {kind, robot, client, number};
}

struct Keeper {
  OrderKeeper keeper{two_robots(), kSelf};
  bool is_held() const { return keeper.is_held(3) || keeper.is_held(4); }
};

TEST_CASE("before any robot has moved, a coordinator gives the scenario's orders") {
  Keeper k;
  CHECK(k.is_held());
  CHECK_FALSE(k.keeper.update(false, false, kNow));
  CHECK(k.keeper.update(true, false, kNow));
  CHECK_FALSE(k.is_held());
  CHECK(k.keeper.take_changes().size() == 1);
  const RememberedOrder* order = k.keeper.book().drive_order(3, Rank::kScenario);
  REQUIRE(order);
  CHECK(order->order.goals.empty());
  CHECK_FALSE(k.keeper.book().drive_order(4, Rank::kScenario));
}

TEST_CASE(
    "a coordinator without orders waits for another process's memory, then holds all robots until an "
    "operator resumes them") {
  Keeper k;
  CHECK_FALSE(k.keeper.update(true, true, kNow));
  CHECK_FALSE(k.keeper.update(true, true, kNow + OrderKeeper::kMaxWait - Duration{1}));
  CHECK(k.is_held());
  CHECK_FALSE(k.keeper.update(false, true, kNow + OrderKeeper::kMaxWait));  // the robots must register again
  CHECK_FALSE(k.keeper.update(true, true, kNow + kSecond * 9));
  CHECK(k.keeper.update(true, true, kNow + kSecond * 9 + OrderKeeper::kMaxWait));
  CHECK(k.keeper.is_complete());
  CHECK(k.is_held());
  const auto number = static_cast<OrderNumber>(to_ns(kNow + kSecond * 20));
  CHECK(k.keeper.on_order(of_kind(msg::OrderKind::ORDER_RESUME, kAllRobots, kClient, number)) ==
        msg::OrderResult::RESULT_REMEMBERED);
  CHECK(k.is_held());
  k.keeper.on_order(of_kind(msg::OrderKind::ORDER_RESUME, kAllRobots, kOperator, number));
  CHECK_FALSE(k.is_held());
}

TEST_CASE("a coordinator learns the orders from the complete memory of a process that knows them") {
  const RememberedOrder hold{of_kind(msg::OrderKind::ORDER_HOLD, 3, kClient, 7)};
  for (const std::uint32_t process : {kOther, 4U}) {
    Keeper k;
    k.keeper.on_page({process, true, 1, 2, {}});  // the first page was lost
    CHECK_FALSE(k.keeper.is_complete());
    k.keeper.on_page({process, false, 0, 2, {}});
    k.keeper.on_page({process, false, 1, 2, {}});
    CHECK_FALSE(k.keeper.is_complete());
    k.keeper.on_page({process, true, 0, 0, {hold}});  // a page with changes only
    CHECK_FALSE(k.keeper.is_complete());
    k.keeper.on_page({process, true, 0, 2, {hold}});
    k.keeper.on_page({process, true, 1, 2, {}});
    CHECK(k.keeper.is_complete());
    CHECK(k.keeper.is_held(3));
    CHECK_FALSE(k.keeper.is_held(4));
  }
}

TEST_CASE(
    "orders are refused for unknown robots, outside the field, and if a later order has replaced them") {
  Keeper k;
  k.keeper.update(true, false, kNow);
  CHECK(k.keeper.on_order(go(9, 5, {0, 0})) == msg::OrderResult::RESULT_UNKNOWN_ROBOT);
  CHECK(k.keeper.on_order(go(3, 5, {2.95, 0})) == msg::OrderResult::RESULT_OUTSIDE_FIELD);
  CHECK(k.keeper.on_order(go(3, 5, {2.9, 0})) == msg::OrderResult::RESULT_REMEMBERED);
  CHECK(k.keeper.on_order(go(3, 5, {2.9, 0})) == msg::OrderResult::RESULT_REMEMBERED);
  CHECK(k.keeper.on_order(go(3, 4, {2.9, 0})) == msg::OrderResult::RESULT_REPLACED);
  CHECK(k.keeper.take_changes().size() == 2);
  CHECK(k.keeper.on_report({3, kClient, 5, {msg::OrderState::ORDER_ARRIVED, 0}}));
  CHECK(k.keeper.book().drive_order(3, Rank::kClient)->progress.is_finished());
}

const Scenario& hundreds() {
  static const Scenario scenario = parse_scenario(
      "field: {length_m: 100, width_m: 100}\nstreams: {count: 300, spacing_m: 1, lanes_crossed: 4}\n",
      "hundreds.yaml");
  return scenario;
}

/// Clients whose orders are numbered in the order of creation.
struct Clients {
  OrderNumber number = 1'700'000'000'000'000'000;
  Order make(msg::OrderKind kind, RobotId robot, ClientId client) { return {kind, robot, client, ++number}; }
  Order hold(RobotId robot, ClientId client = kClient) {
    return make(msg::OrderKind::ORDER_HOLD, robot, client);
  }
  Order resume(RobotId robot, ClientId client = kClient) {
    return make(msg::OrderKind::ORDER_RESUME, robot, client);
  }
  Order zone(msg::OrderKind kind, std::uint32_t zone_number) {
    Order order = make(kind, kAllRobots, kClient);
    order.zone_number = zone_number;
    if (kind == msg::OrderKind::ORDER_ZONE) order.zone.corners_m = {{0, 0}};
    return order;
  }
};

constexpr auto kRemembered = msg::OrderResult::RESULT_REMEMBERED;

TEST_CASE(
    "clients that have lifted their holds and removed their zones can hold robots and draw zones again") {
  OrderKeeper keeper(hundreds(), kSelf);
  Clients clients;
  for (RobotId robot = 0; robot < 300; ++robot) {
    REQUIRE(keeper.on_order(clients.hold(robot)) == kRemembered);
    REQUIRE(keeper.on_order(clients.resume(robot)) == kRemembered);
    REQUIRE(keeper.on_order(clients.zone(msg::OrderKind::ORDER_ZONE, robot)) == kRemembered);
    REQUIRE(keeper.on_order(clients.zone(msg::OrderKind::ORDER_REMOVE_ZONE, robot)) == kRemembered);
  }
  CHECK(keeper.on_order(clients.hold(200)) == kRemembered);
  CHECK(keeper.on_order(clients.hold(200, kClient + 1)) == kRemembered);
  CHECK(keeper.on_order(clients.zone(msg::OrderKind::ORDER_ZONE, 1000)) == kRemembered);
}

TEST_CASE("a client whose holds fill the memory can lift them") {
  OrderKeeper keeper(hundreds(), kSelf);
  Clients clients;
  for (RobotId robot = 0; robot < OrderBook::kMaxHolds; ++robot)
    REQUIRE(keeper.on_order(clients.hold(robot)) == kRemembered);
  CHECK(keeper.on_order(clients.hold(299)) == msg::OrderResult::RESULT_TOO_MANY);
  CHECK(keeper.on_order(clients.hold(299, kOperator)) == kRemembered);
  CHECK(keeper.on_order(clients.resume(0)) == kRemembered);
  CHECK(keeper.on_order(clients.hold(299)) == kRemembered);
  CHECK(keeper.on_order(clients.resume(kAllRobots)) == kRemembered);
  CHECK(keeper.book().hold_count() == 1);  // the operator's hold remains
}

TEST_CASE("a hold accepted by one coordinator is stored by all others, even if their memories are full") {
  OrderKeeper active(hundreds(), kSelf), standby(hundreds(), kOther);
  for (OrderKeeper* keeper : {&active, &standby}) (void)keeper->update(true, false, kNow);
  const auto page = [](const OrderKeeper& from, std::uint32_t process) {
    return OrderPage{process, true, 0, 1, from.book().all()};
  };
  Clients clients;
  for (RobotId robot = 0; robot + 1 < OrderBook::kMaxHolds; ++robot) {
    const Order hold = clients.hold(robot);
    REQUIRE(active.on_order(hold) == kRemembered);
    REQUIRE(standby.on_order(hold) == kRemembered);
  }
  // Two clients hold two robots at the same time, and the coordinators receive the holds in different order.
  const Order a = clients.hold(280), b = clients.hold(281, kClient + 1);
  CHECK(standby.on_order(b) == kRemembered);
  CHECK(active.on_order(a) == kRemembered);
  CHECK(active.on_order(b) == msg::OrderResult::RESULT_TOO_MANY);
  CHECK(standby.on_order(a) == msg::OrderResult::RESULT_TOO_MANY);
  (void)standby.on_page(page(active, kSelf));
  (void)active.on_page(page(standby, kOther));
  for (const OrderKeeper* keeper : {&active, &standby}) {
    CHECK(keeper->is_held(280));
    CHECK(keeper->is_held(281));
  }
}

TEST_CASE("if a client floods a memory with holds, all robots are held until an operator resumes them") {
  OrderKeeper keeper(hundreds(), kSelf);
  (void)keeper.update(true, false, kNow);
  Clients clients;
  for (ClientId client = 0; client < OrderKeeper::kMaxMergedHolds; ++client)
    (void)keeper.on_page({kOther, true, 0, 0, {{clients.hold(7, kClient + client)}}});
  CHECK_FALSE(keeper.is_held(8));
  const Order last = clients.hold(9);
  CHECK(keeper.on_page({kOther, true, 0, 0, {{last}}}));
  CHECK(keeper.is_held(8));
  for (ClientId client = 0; client < 1000; ++client)
    (void)keeper.on_page({kOther, true, 0, 0, {{clients.hold(7, 2 * kClient + client)}}});
  CHECK(keeper.book().hold_count() == OrderKeeper::kMaxMergedHolds + 1);
  CHECK(keeper.on_order(clients.resume(kAllRobots, kOperator)) == kRemembered);
  CHECK_FALSE(keeper.is_held(7));
  CHECK_FALSE(keeper.is_held(8));
}

TEST_CASE("a coordinator knows the orders once an agent that knows them has registered") {
  Keeper k;
  k.keeper.on_registration(false);
  CHECK_FALSE(k.keeper.is_complete());
  k.keeper.on_registration(true);
  CHECK(k.keeper.is_complete());
  CHECK_FALSE(k.is_held());
}

}  // namespace sidestep::order_keeper_test
