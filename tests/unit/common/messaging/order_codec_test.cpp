// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/order_codec.hpp"

#include <limits>

#include "tests/catch.hpp"

namespace sidestep::order_codec_test {

constexpr Time kNow = time_from_ns(1'000'000'000'000);
constexpr ClientId kClient = 1'000'001;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Order go(RobotId robot = 3) {
  Order order{msg::OrderKind::ORDER_GO, robot, kClient, 999'000'000'000};
  order.goals = {{{1, 2}}, {{3, 4}, 1.5, 0.5, 0.1}};
  return order;
}
Order zone() {
  Order order{msg::OrderKind::ORDER_ZONE, kAllRobots, kClient, 999'000'000'000};
  order.zone_number = 7;
  order.zone = {{{0, 0}, {1, 0}, {0, 1}}, 0.5, 1.5};
  return order;
}

TEST_CASE("orders survive encoding and decoding") {
  const auto order = decode(encode(go()), kNow);
  REQUIRE(order);
  CHECK(order->robot == 3);
  CHECK(order->client == kClient);
  CHECK(order->number == 999'000'000'000);
  REQUIRE(order->goals.size() == 2);
  CHECK_FALSE(order->goals[0].heading_rad);
  CHECK_FALSE(order->goals[0].speed_limit_mps);
  CHECK_FALSE(order->goals[0].tolerance_m);
  CHECK(order->goals[1].position_m == Vec2(3, 4));
  CHECK(order->goals[1].heading_rad == 1.5);
  CHECK(order->goals[1].speed_limit_mps == 0.5);
  CHECK(order->goals[1].tolerance_m == 0.1);
  const auto area = decode(encode(zone()), kNow);
  REQUIRE(area);
  CHECK(area->zone_number == 7);
  CHECK(area->zone.corners_m.size() == 3);
  CHECK(area->zone.radius_m == 0.5);
  CHECK(area->zone.speed_limit_mps == 1.5);
}

TEST_CASE("orders and reports carry the name of their client") {
  Order order = go();
  order.client = client_id("kitchen-2");
  order.client_name = client_name("kitchen-2");
  const auto decoded = decode(encode(order), kNow);
  REQUIRE(decoded);
  CHECK(to_text(decoded->client_name) == "kitchen-2");
  OrderReport report{3, order.client, 5};
  report.client_name = order.client_name;
  msg::OrderStatus status = encode(report);
  status.header().sender(3);
  REQUIRE(decode(status));
  CHECK(to_text(decode(status)->client_name) == "kitchen-2");
}

TEST_CASE("a name that is not the client's, or that no terminal should print, is refused") {
  Order order = go();
  order.client = client_id("kitchen");
  const auto is_accepted = [&](const ClientName& name) {
    OrderReport report{3, order.client, 5};
    report.client_name = order.client_name = name;
    msg::OrderStatus status = encode(report);
    status.header().sender(3);
    const bool is_order_accepted = decode(encode(order), kNow).has_value();
    CHECK(decode(status).has_value() == is_order_accepted);
    return is_order_accepted;
  };
  CHECK(is_accepted(client_name("kitchen")));
  CHECK(is_accepted({}));
  CHECK_FALSE(is_accepted(client_name("hall")));
  ClientName after_the_end = client_name("kitchen");
  after_the_end.back() = 'x';
  CHECK_FALSE(is_accepted(after_the_end));
  order.client = client_id("\x1b[2J");
  ClientName hostile{};
  std::ranges::copy(std::string_view("\x1b[2J"), hostile.begin());
  CHECK_FALSE(is_accepted(hostile));
}

TEST_CASE("a client whose name does not fit has none") {
  CHECK(to_text(client_name("kitchen")) == "kitchen");
  CHECK(to_text(client_name(std::string(msg::MAX_CLIENT_NAME, 'x'))) ==
        std::string(msg::MAX_CLIENT_NAME, 'x'));
  CHECK(client_name(std::string(msg::MAX_CLIENT_NAME + 1, 'x')) == ClientName{});
  CHECK(client_name("two words") == ClientName{});
  CHECK(client_name("k\xc3\xbc"
                    "che") == ClientName{});
}

TEST_CASE("orders from senders who may not give them or with a value out of range are refused") {
  const auto is_refused = [](msg::Order message, auto spoil) {
    REQUIRE(decode(message, kNow));
    spoil(message);
    return !decode(message, kNow);
  };
  for (const std::uint32_t sender : {3U, 1023U, 10000U, 20000U, 30000U, 60000U, 999'999U})
    CHECK(is_refused(encode(go()), [&](msg::Order& m) { m.header().sender(sender); }));
  const auto terms = [&](const Order& order, auto spoil) {
    return is_refused(encode(order), [&](msg::Order& m) { spoil(m.terms()); });
  };
  CHECK(terms(go(), [](auto& t) { t.order_kind(static_cast<msg::OrderKind>(6)); }));
  CHECK(terms(go(), [](auto& t) { t.order_kind(msg::OrderKind::ORDER_HOLD); }));  // a hold has no goals
  CHECK(terms(go(), [](auto& t) { t.order_number(0); }));
  CHECK(terms(go(), [](auto& t) { t.order_number(to_ns(kNow) + 3'700'000'000'000); }));
  CHECK(terms(zone(), [](auto& t) { t.zone_radius_m(kNan); }));
  CHECK(terms(zone(), [](auto& t) { t.zone_radius_m(-1); }));
  CHECK(terms(zone(), [](auto& t) { t.zone_speed_limit_mps(kNan); }));
  CHECK(is_refused(encode(zone()), [](msg::Order& m) { m.robot(3); }));
  CHECK(is_refused(encode(zone()), [](msg::Order& m) { m.poses().clear(); }));
  CHECK(is_refused(encode(go()), [](msg::Order& m) { m.robot(kAllRobots); }));
  CHECK(is_refused(encode(go()), [](msg::Order& m) { m.poses().clear(); }));
  const auto pose = [&](auto spoil) {
    return is_refused(encode(go()), [&](msg::Order& m) { spoil(m.poses()[1]); });
  };
  for (const double value : {kNan, 1e300, -1e300}) {
    CHECK(pose([&](auto& p) { p.x_m(value); }));
    CHECK(pose([&](auto& p) { p.y_m(value); }));
    CHECK(pose([&](auto& p) { p.heading_rad(value); }));
    CHECK(pose([&](auto& p) { p.speed_limit_mps(value); }));
    CHECK(pose([&](auto& p) { p.tolerance_m(value); }));
  }
}

TEST_CASE("an order memory of any size is sent on as many pages as necessary") {
  std::vector<RememberedOrder> orders;
  for (RobotId robot = 0; robot < 100; ++robot) {
    RememberedOrder order{go(robot), {msg::OrderState::ORDER_ARRIVED, 1}};
    order.order.goals.resize(robot % 2 ? 64 : 1, {{5, 6}});
    orders.push_back(order);
  }
  orders.push_back({zone()});
  std::vector<RememberedOrder> decoded;
  const auto pages = encode(orders, true, false);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    msg::OrderMemory message = pages[i];
    message.process(10001);
    message.header().sender(10001);
    CHECK(message.poses().size() <= msg::MAX_MEMORY_POSES);
    const auto page = decode(message, kNow);
    REQUIRE(page);
    CHECK(page->index == i);
    CHECK(page->count == pages.size());
    CHECK(page->is_complete);
    decoded.insert(decoded.end(), page->orders.begin(), page->orders.end());
    message.page_count(kMaxOrderPages + 1);
    CHECK_FALSE(decode(message, kNow));
    message.page_count(kMaxOrderPages);
    CHECK(decode(message, kNow));
    message.process(10000);
    CHECK_FALSE(decode(message, kNow));  // sent in the name of another process
  }
  REQUIRE(decoded.size() == orders.size());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    CHECK(decoded[i].order.robot == orders[i].order.robot);
    CHECK(decoded[i].order.goals.size() == orders[i].order.goals.size());
    CHECK(decoded[i].progress.goal_index == orders[i].progress.goal_index);
  }
  const auto changes = encode({orders.data(), 1}, false, true);
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].page_count() == 0);
  CHECK(encode(std::span<const RememberedOrder>(), true, false).size() == 1);
}

TEST_CASE("a scenario may only order robots to their own goals, and a coordinator may only hold robots") {
  const auto page_with = [](const Order& order) {
    const RememberedOrder remembered{order};
    msg::OrderMemory message = encode({&remembered, 1}, true, false).front();
    message.process(3);
    message.header().sender(3);
    return decode(message, kNow);
  };
  const auto kScenario = static_cast<ClientId>(Sender::kScenario);
  CHECK(page_with({msg::OrderKind::ORDER_GO, 3, kScenario, 1}));
  CHECK_FALSE(page_with({msg::OrderKind::ORDER_HOLD, 3, kScenario, 1}));
  CHECK_FALSE(page_with({msg::OrderKind::ORDER_GO, 3, kClient, 1}));
  CHECK(page_with({msg::OrderKind::ORDER_HOLD, kAllRobots, 10001, 1}));
  CHECK_FALSE(page_with({msg::OrderKind::ORDER_RESUME, kAllRobots, 10001, 1}));
  CHECK_FALSE(page_with({msg::OrderKind::ORDER_HOLD, 3, 20000, 1}));
}

TEST_CASE("an agent's report on its order survives encoding and decoding") {
  OrderReport report{3, kClient, 17, {msg::OrderState::ORDER_DRIVING, 2}};
  report.is_held = true;
  report.blockage = Blockage{msg::BlockReason::BLOCK_ROBOT, 5, {1, 2}, {3, 4}};
  msg::OrderStatus message = encode(report);
  message.header().sender(3);
  CHECK(message.order_state() == msg::OrderState::ORDER_BLOCKED);
  const auto decoded = decode(message);
  REQUIRE(decoded);
  CHECK(decoded->client == kClient);
  CHECK(decoded->number == 17);
  CHECK(decoded->progress.state == msg::OrderState::ORDER_DRIVING);
  CHECK(decoded->progress.goal_index == 2);
  CHECK(decoded->is_held);
  REQUIRE(decoded->blockage);
  CHECK(decoded->blockage->reason == msg::BlockReason::BLOCK_ROBOT);
  CHECK(decoded->blockage->blocker == 5);
  CHECK(decoded->blockage->blocker_m == Vec2(1, 2));
  CHECK(decoded->blockage->nearest_m == Vec2(3, 4));
  CHECK_FALSE(decoded->remaining_s);
  // A robot that has arrived and must then leave a zone has still arrived.
  report.progress.state = msg::OrderState::ORDER_ARRIVED;
  CHECK(encode(report).order_state() == msg::OrderState::ORDER_ARRIVED);
  report.blockage.reset();
  report.remaining_s = 2.5;
  message = encode(report);
  message.header().sender(3);
  CHECK(decode(message)->remaining_s == 2.5);
  CHECK_FALSE(decode(message)->blockage);
}

TEST_CASE("an agent's report with a value out of range or about another robot is refused") {
  OrderReport report{3, kClient, 17, {msg::OrderState::ORDER_DRIVING, 2}};
  report.blockage = Blockage{};
  msg::OrderStatus good = encode(report);
  good.header().sender(3);
  REQUIRE(decode(good));
  const auto is_refused_with = [&](auto change) {
    msg::OrderStatus message = good;
    change(message);
    return !decode(message);
  };
  CHECK(is_refused_with([](auto& m) { m.header().sender(4); }));
  CHECK(is_refused_with([](auto& m) { m.order_state(static_cast<msg::OrderState>(5)); }));
  CHECK(is_refused_with([](auto& m) { m.block_reason(static_cast<msg::BlockReason>(8)); }));
  CHECK(is_refused_with([](auto& m) { m.block_reason(msg::BlockReason::BLOCK_NONE); }));
  CHECK(is_refused_with([](auto& m) { m.blocker_x_m(kNan); }));
  CHECK(is_refused_with([](auto& m) { m.blocker_y_m(1e5); }));
  CHECK(is_refused_with([](auto& m) { m.nearest_x_m(-1e5); }));
  CHECK(is_refused_with([](auto& m) { m.blocker_speed_mps(kNan); }));
  CHECK(is_refused_with([](auto& m) { m.blocker_speed_mps(-1); }));
  CHECK(is_refused_with([](auto& m) { m.blocker_speed_mps(1e300); }));
  CHECK(is_refused_with([](auto& m) { m.nearest_y_m(kNan); }));
  CHECK(is_refused_with([](auto& m) { m.remaining_s(kNan); }));
  CHECK(is_refused_with([](auto& m) { m.remaining_s(1e10); }));
}

}  // namespace sidestep::order_codec_test
