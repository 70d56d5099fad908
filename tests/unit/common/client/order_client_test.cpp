// SPDX-License-Identifier: Apache-2.0
#include "common/client/order_client.hpp"

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::order_client_test {

using namespace std::chrono_literals;

constexpr ClientId kClient = 1'000'001;
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);

/// A client, and a process that answers like a coordinator.
struct System {
  SimNetwork network{1, time_from_ns(1'000'000'000'000), NetworkSpec{}};
  SimBus client_bus{network}, coordinator_bus{network};
  OrderClient client{client_bus, kClient};
  Writer<msg::OrderAnswer> answers = coordinator_bus.advertise(topics::kOrderAnswer);
  Writer<msg::OrderMemory> memory = coordinator_bus.advertise(topics::kOrderMemory);
  OrderBook book;
  std::vector<Order> received;
  std::vector<OrderPhase> phases;  ///< phases that the client has reported
  bool answers_orders = true;

  System() {
    client.on_change([this](const SentOrder& sent) { phases.push_back(sent.phase); });
    coordinator_bus.subscribe(topics::kOrder, [this](const msg::Order& message) {
      const auto order = decode(message, coordinator_bus.now());
      REQUIRE(order);
      received.push_back(*order);
      if (answers_orders) answer(*order);
    });
  }
  void answer(const Order& order) {
    const bool is_replaced = book.merge({order}) == OrderBook::Outcome::kReplaced;
    msg::OrderAnswer message;
    message.header().sender(kCoordinator);
    message.client(order.client);
    message.order_number(order.number);
    message.result(is_replaced ? msg::OrderResult::RESULT_REPLACED : msg::OrderResult::RESULT_REMEMBERED);
    message.newest_number(book.newest_number());
    answers.publish(message, coordinator_bus.now());
  }
  void tell_memory() { tell_memory(kCoordinator, book); }
  void tell_memory(std::uint32_t coordinator, const OrderBook& remembered) {
    for (msg::OrderMemory& page : encode(remembered.all(), true, false)) {
      page.process(coordinator);
      page.header().sender(coordinator);
      memory.publish(page, coordinator_bus.now());
    }
    run_for(10ms);
  }
  void run_for(Duration duration) { network.run_until(network.now() + duration); }
};

Zone disc(double x_m) { return {{{x_m, 0}}, 0.5}; }

TEST_CASE("a zone order applies to all robots and is complete when a coordinator remembers it") {
  System system;
  const OrderHandle first = system.client.zone(1, disc(1)), second = system.client.zone(2, disc(2));
  system.run_for(1s);
  REQUIRE(system.received.size() == 2);
  CHECK(system.received[0].kind == msg::OrderKind::ORDER_ZONE);
  CHECK(system.received[0].robot == kAllRobots);
  CHECK(system.received[0].zone_number == 1);
  CHECK(system.received[0].zone.corners_m[0] == Vec2(1, 0));
  CHECK(system.received[1].zone_number == 2);
  CHECK(system.client.find(first)->phase == OrderPhase::kAccepted);
  CHECK(system.client.find(second)->phase == OrderPhase::kAccepted);
  CHECK(system.book.zones().size() == 2);
  const OrderHandle removal = system.client.remove_zone(1);
  system.run_for(1s);
  CHECK(system.client.find(removal)->phase == OrderPhase::kAccepted);
  CHECK(system.client.find(first) == nullptr);
  CHECK(system.book.zones().size() == 1);
}

TEST_CASE("the orders of a client carry its name") {
  System system;
  OrderClient kitchen(system.client_bus, client_id("kitchen"), "kitchen");
  kitchen.hold(3);
  system.client.hold(4);
  system.run_for(100ms);
  REQUIRE(system.received.size() == 2);
  CHECK(to_text(system.received[0].client_name) == "kitchen");
  CHECK(to_text(system.received[1].client_name).empty());
}

TEST_CASE("a client knows the zones that any coordinator remembers once it has heard a whole memory") {
  System system;
  const auto zones = [&] { return system.client.remembered_orders()->zones(); };
  CHECK_FALSE(system.client.remembered_orders());
  system.tell_memory();
  REQUIRE(system.client.remembered_orders());
  CHECK(zones().empty());
  OrderBook other;
  Order zone{msg::OrderKind::ORDER_ZONE, kAllRobots, kClient + 1, 5};
  zone.zone_number = 7;
  zone.zone = disc(1);
  (void)other.merge({zone});
  system.tell_memory(kCoordinator + 1, other);
  REQUIRE(zones().size() == 1);
  CHECK(zones().front().zone_number == 7);
  CHECK(zones().front().client == kClient + 1);
  zone.kind = msg::OrderKind::ORDER_REMOVE_ZONE;
  zone.zone = {};
  zone.number = 6;
  (void)other.merge({zone});
  system.tell_memory(kCoordinator + 1, other);
  CHECK(zones().empty());
}

TEST_CASE("a client knows which coordinators have told their memories") {
  System system;
  CHECK_FALSE(system.client.has_memory_of(kCoordinator));
  system.tell_memory();
  CHECK(system.client.has_memory_of(kCoordinator));
  CHECK_FALSE(system.client.has_memory_of(kCoordinator + 1));
}

TEST_CASE("a client may have a zone that it has set, that coordinators remember, or as long as none tells") {
  System system;
  CHECK(system.client.may_have_zone(7));
  system.tell_memory();
  CHECK_FALSE(system.client.may_have_zone(7));
  system.client.zone(7, disc(1));
  CHECK(system.client.may_have_zone(7));
  CHECK_FALSE(system.client.may_have_zone(8));
  system.run_for(100ms);
  system.tell_memory();
  // Another process of the same client.
  SimBus other_bus(system.network);
  OrderClient other(other_bus, kClient);
  system.run_for(1s);
  CHECK(other.may_have_zone(8));
  system.tell_memory();
  CHECK_FALSE(other.may_have_zone(8));
  CHECK(other.may_have_zone(7));
  system.client.remove_zone(7);
  system.run_for(100ms);
  system.tell_memory();
  CHECK_FALSE(system.client.may_have_zone(7));
  CHECK_FALSE(other.may_have_zone(7));
}

TEST_CASE("a client forgets what only a dead coordinator remembered once another one repeats its memory") {
  System system;
  const auto zones = [&] { return system.client.remembered_orders()->zones(); };
  OrderBook other;
  Order zone{msg::OrderKind::ORDER_ZONE, kAllRobots, kClient + 1, 5};
  zone.zone_number = 7;
  zone.zone = disc(1);
  (void)other.merge({zone});
  for (int i = 0; i < 10; ++i) {
    system.tell_memory(kCoordinator + 1, other);
    system.tell_memory();
    system.run_for(1s);
  }
  CHECK(zones().size() == 1);
  SECTION("the other coordinator lives") {
    for (int i = 0; i < 5; ++i) {
      system.tell_memory();
      system.run_for(1s);
    }
    CHECK(zones().empty());
    system.tell_memory(kCoordinator + 1, other);
    CHECK(zones().size() == 1);
  }
  SECTION("no coordinator lives") {
    system.run_for(60s);
    CHECK(zones().size() == 1);
  }
}

TEST_CASE("a client knows who holds a robot, also if one of two coordinators has died since") {
  System system;
  const auto is_held = [&] { return system.client.remembered_orders()->is_held(3); };
  const Order hold{msg::OrderKind::ORDER_HOLD, 3, kClient + 1, 5};
  OrderBook other;
  (void)other.merge({hold});
  system.tell_memory(kCoordinator + 1, other);
  system.tell_memory();
  REQUIRE(system.client.remembered_orders()->holds_of(3).size() == 1);
  CHECK(system.client.remembered_orders()->holds_of(3).front().client == kClient + 1);
  CHECK(system.client.remembered_orders()->holds_of(4).empty());
  SECTION("the other one lifts the hold, and repeats all orders") {
    (void)system.book.merge({{msg::OrderKind::ORDER_RESUME, 3, kClient + 1, 6}});
    system.tell_memory();
    CHECK_FALSE(is_held());
  }
  SECTION("the other one announces that the hold is lifted") {
    const RememberedOrder resume{{msg::OrderKind::ORDER_RESUME, 3, kClient + 1, 6}};
    for (msg::OrderMemory& page : encode(std::span(&resume, 1), true, true)) {
      page.process(kCoordinator);
      page.header().sender(kCoordinator);
      system.memory.publish(page, system.coordinator_bus.now());
    }
    system.run_for(10ms);
    CHECK_FALSE(is_held());
  }
}

TEST_CASE("a zone is not reported as replaced if its own client moves it") {
  System system;
  for (int i = 0; i < 100; ++i) {
    system.client.zone(1, disc(0.01 * i));
    system.run_for(3ms);
  }
  system.run_for(1s);
  CHECK(std::ranges::count(system.phases, OrderPhase::kReplaced) == 0);
  REQUIRE(system.book.zones().size() == 1);
  CHECK(system.book.zones()[0].zone.corners_m[0] == Vec2(0.99, 0));
}

TEST_CASE("if a zone moves while no coordinator answers, only its last position is repeated") {
  System system;
  system.answers_orders = false;
  OrderHandle last = 0;
  for (int i = 0; i < 600; ++i) {
    last = system.client.zone(1, disc(0.01 * i));
    system.run_for(10ms);
  }
  system.received.clear();
  system.answers_orders = true;
  system.run_for(1s);
  REQUIRE(system.received.size() == 1);
  CHECK(system.received[0].zone.corners_m[0] == Vec2(5.99, 0));
  CHECK(system.client.find(last)->phase == OrderPhase::kAccepted);
}

TEST_CASE("a client keeps a zone in force while it forgets older finished orders") {
  System system;
  const OrderHandle standing = system.client.zone(7, disc(1));
  std::vector<OrderHandle> handles;
  for (int i = 0; i < 6000; ++i) {
    handles.push_back(system.client.zone(1, disc(0.001 * i)));
    handles.push_back(system.client.hold(0));
    system.run_for(5ms);
  }
  const auto is_known = [&](OrderHandle handle) { return system.client.find(handle) != nullptr; };
  // Besides kMaxFinal finished orders, the last zone and the last hold are known: they are in force.
  CHECK(static_cast<std::size_t>(std::ranges::count_if(handles, is_known)) == OrderClient::kMaxFinal + 2);
  CHECK(is_known(standing));
  CHECK(is_known(handles.back()));
}

TEST_CASE("a zone that all coordinators have forgotten is sent again") {
  System system;
  const OrderHandle zone = system.client.zone(1, disc(1)), removed = system.client.zone(2, disc(2));
  system.client.remove_zone(2);
  system.run_for(1s);
  system.tell_memory();
  CHECK(system.client.find(zone)->phase == OrderPhase::kAccepted);
  system.book = {};
  system.received.clear();
  for (int i = 0; i < 5; ++i) {
    system.tell_memory();
    system.run_for(1s);
  }
  REQUIRE(system.received.size() == 1);
  CHECK(system.received[0].zone_number == 1);
  CHECK(system.client.find(zone)->phase == OrderPhase::kAccepted);
  CHECK(system.client.find(removed) == nullptr);
}

/// Whether the client sends the order again after all coordinators have forgotten it.
bool is_sent_again(System& system, OrderHandle handle) {
  system.received.clear();
  for (int i = 0; i < 5; ++i) {
    system.tell_memory();
    system.run_for(1s);
  }
  const OrderNumber number = system.client.find(handle)->order.number;
  return std::ranges::any_of(system.received, [=](const Order& order) { return order.number == number; });
}

TEST_CASE("a drive order and a hold that all coordinators have forgotten are sent again unchanged") {
  System system;
  const OrderHandle go = system.client.go(0, {{{1, 0}}}), hold = system.client.hold(3);
  system.run_for(1s);
  system.tell_memory();
  const OrderNumber number = system.client.find(hold)->order.number;
  for (const OrderHandle handle : {go, hold}) {
    INFO("order " << handle);
    CHECK(system.client.find(handle)->phase == OrderPhase::kAccepted);
    CHECK_FALSE(is_sent_again(system, handle));
    system.book = {};
    CHECK(is_sent_again(system, handle));
    CHECK(system.client.find(handle)->phase == OrderPhase::kAccepted);
  }
  CHECK(system.client.find(hold)->order.number == number);
  CHECK(system.book.is_held(3));
  CHECK(system.book.drive_order(0, Rank::kClient));
  const OrderHandle hold_all = system.client.hold(kAllRobots);
  system.run_for(1s);
  CHECK(system.client.find(hold)->phase == OrderPhase::kReplaced);
  system.book = {};
  CHECK(is_sent_again(system, hold_all));
  CHECK(system.book.is_held(4));
}

TEST_CASE("an order that a coordinator has forgotten is sent again even if another coordinator lists it") {
  System system;
  const OrderHandle go = system.client.go(0, {{{1, 0}}});
  system.run_for(100ms);
  const OrderBook before = system.book;
  system.book = {};
  system.received.clear();
  system.phases.clear();
  for (int i = 0; i < 5; ++i) {
    system.tell_memory();
    system.tell_memory(kCoordinator + 1, before);
    system.run_for(1s);
  }
  REQUIRE(system.received.size() == 1);
  CHECK(system.received[0].number == system.client.find(go)->order.number);
  CHECK(system.book.drive_order(0, Rank::kClient));
  CHECK(system.client.find(go)->phase == OrderPhase::kAccepted);
  // Some process remembers the order at all times.
  CHECK(system.phases.empty());
}

TEST_CASE("an order that a coordinator lists is repeated until a coordinator answers or the robot starts") {
  const auto state = GENERATE(msg::OrderState::ORDER_ACCEPTED, msg::OrderState::ORDER_DRIVING);
  CAPTURE(static_cast<int>(state));
  System system;
  system.answers_orders = false;
  const OrderHandle go = system.client.go(0, {{{1, 0}}});
  system.run_for(10ms);
  REQUIRE(system.received.size() == 1);
  system.book.merge({system.received[0]});
  system.book.report(0, kClient, system.received[0].number, {state, 0});
  for (int i = 0; i < 5; ++i) system.tell_memory();
  system.run_for(1s);
  const bool has_started = state != msg::OrderState::ORDER_ACCEPTED;
  CHECK((system.client.find(go)->phase == OrderPhase::kSent) == !has_started);
  CHECK((system.received.size() == 1) == has_started);
}

TEST_CASE("a hold that its owner or an operator lifted is not sent again") {
  const bool by_owner = GENERATE(true, false);
  CAPTURE(by_owner);
  System system;
  const OrderHandle hold = system.client.hold(3);
  system.run_for(100ms);
  const Order resume{msg::OrderKind::ORDER_RESUME, kAllRobots, static_cast<ClientId>(Sender::kOperator),
                     static_cast<OrderNumber>(to_ns(system.client_bus.now()))};
  if (by_owner)
    system.client.resume(kAllRobots);
  else
    system.book.merge({resume});
  system.run_for(100ms);
  system.tell_memory();
  CHECK(system.client.find(hold)->phase == OrderPhase::kReplaced);
  system.book = {};
  CHECK_FALSE(is_sent_again(system, hold));
}

TEST_CASE("an order that ended another order is sent again if only the ended order reappears") {
  System system;
  const auto kind =
      GENERATE(msg::OrderKind::ORDER_CANCEL, msg::OrderKind::ORDER_RESUME, msg::OrderKind::ORDER_REMOVE_ZONE);
  CAPTURE(static_cast<int>(kind));
  system.client.go(0, {{{1, 0}}});
  system.client.hold(3);
  system.client.zone(2, disc(1));
  system.run_for(100ms);
  const OrderBook before = system.book;
  const OrderHandle ending = kind == msg::OrderKind::ORDER_CANCEL   ? system.client.cancel(0)
                             : kind == msg::OrderKind::ORDER_RESUME ? system.client.resume(kAllRobots)
                                                                    : system.client.remove_zone(2);
  system.run_for(100ms);
  REQUIRE(system.client.find(ending)->phase == OrderPhase::kAccepted);
  CHECK_FALSE(is_sent_again(system, ending));
  system.book = {};
  CHECK_FALSE(is_sent_again(system, ending));
  system.book = before;
  CHECK(is_sent_again(system, ending));
  CHECK(system.book.stands(system.client.find(ending)->order));
  CHECK(system.client.find(ending)->phase == OrderPhase::kAccepted);
  CHECK_FALSE(is_sent_again(system, ending));
}

TEST_CASE("a drive order that the robot has finished is sent again if the order before it reappears") {
  System system;
  system.client.go(0, {{{1, 0}}});
  system.run_for(100ms);
  const OrderBook before = system.book;
  const OrderHandle second = system.client.go(0, {{{2, 0}}});
  system.run_for(100ms);
  system.book.report(0, kClient, system.client.find(second)->order.number,
                     {msg::OrderState::ORDER_ARRIVED, 0});
  system.tell_memory();
  REQUIRE(system.client.find(second)->phase == OrderPhase::kArrived);
  system.book = before;
  CHECK(is_sent_again(system, second));
  CHECK(system.book.stands(system.client.find(second)->order));
  CHECK(system.client.find(second)->phase == OrderPhase::kArrived);
}

TEST_CASE("a hold of one robot stays in force after its client resumes another robot") {
  System system;
  const OrderHandle hold = system.client.hold(3);
  system.run_for(100ms);
  system.client.resume(4);
  system.run_for(100ms);
  system.book = {};
  CHECK(is_sent_again(system, hold));
  CHECK(system.book.is_held(3));
}

TEST_CASE("a client can move its zone even if its clock is behind its earlier orders") {
  System system;
  Order earlier{msg::OrderKind::ORDER_ZONE, kAllRobots, kClient};
  earlier.number = static_cast<OrderNumber>(to_ns(system.client_bus.now() + 20s));
  earlier.zone_number = 1;
  earlier.zone = disc(1);
  system.book.merge({earlier});
  const OrderHandle zone = system.client.zone(1, disc(2));
  system.run_for(1s);
  CHECK(system.client.find(zone)->phase == OrderPhase::kAccepted);
  CHECK(system.book.zones()[0].zone.corners_m[0] == Vec2(2, 0));
}

TEST_CASE("a zone that another process with the same client name overwrites is reported as replaced") {
  System system;
  const OrderHandle zone = system.client.zone(1, disc(1));
  system.run_for(1s);
  SimBus other_bus(system.network);
  OrderClient other(other_bus, kClient);
  system.run_for(1s);
  other.zone(1, disc(2));
  system.run_for(1s);
  system.tell_memory();
  CHECK(system.client.find(zone)->phase == OrderPhase::kReplaced);
}

TEST_CASE("a client may send the next position of a zone once the previous position is confirmed") {
  System system;
  int sent = 1;
  system.client.on_change([&](const SentOrder&) {
    if (sent < 2000) system.client.zone(1, disc(0.001 * ++sent));
  });
  system.client.zone(1, disc(0));
  system.run_for(20s);
  CHECK(sent == 2000);
  CHECK(system.book.zones()[0].zone.corners_m[0].x() == Approx(2));
}

TEST_CASE("a lost resume is not repeated after a later hold") {
  System system;
  system.answers_orders = false;
  const OrderHandle resume = system.client.resume(kAllRobots);
  system.run_for(500ms);
  system.client.hold(kAllRobots);
  CHECK(system.client.find(resume)->phase == OrderPhase::kReplaced);
  system.received.clear();
  system.answers_orders = true;
  system.run_for(1s);
  REQUIRE(system.received.size() == 1);
  CHECK(system.received[0].kind == msg::OrderKind::ORDER_HOLD);
  CHECK(system.book.is_held(3));
}

TEST_CASE("a lost resume of all robots does not end a later hold of one robot") {
  System system;
  system.answers_orders = false;
  system.client.resume(kAllRobots);
  system.run_for(500ms);
  const OrderHandle hold = system.client.hold(3);
  system.run_for(10ms);
  system.answer(system.client.find(hold)->order);
  system.answers_orders = true;
  system.run_for(1s);
  CHECK(system.book.is_held(3));
  CHECK_FALSE(system.book.is_held(4));
}

TEST_CASE(
    "a repeated resume does not override another client's later hold unless this client's clock is behind") {
  const bool is_clock_behind = GENERATE(false, true);
  System system;
  system.answers_orders = false;
  const OrderHandle resume = system.client.resume(kAllRobots);
  const OrderNumber first = system.client.find(resume)->order.number;
  system.run_for(500ms);
  Order hold{msg::OrderKind::ORDER_HOLD, 3, kClient + 1};
  hold.number = static_cast<OrderNumber>(to_ns(system.client_bus.now() + (is_clock_behind ? 5s : 0s)));
  system.book.merge({hold});
  system.answers_orders = true;
  system.run_for(1s);
  const SentOrder* const sent = system.client.find(resume);
  REQUIRE(sent);
  CHECK(sent->phase == OrderPhase::kAccepted);
  CHECK((sent->order.number == first) == !is_clock_behind);
  CHECK((sent->order.number > hold.number) == is_clock_behind);
}

TEST_CASE("a robot follows the latest drive order even if the previous drive order was lost") {
  System system;
  system.answers_orders = false;
  const OrderHandle first = system.client.go(0, {{{1, 0}}});
  system.run_for(500ms);
  const OrderHandle second = system.client.go(0, {{{2, 0}}});
  system.answers_orders = true;
  system.run_for(1s);
  CHECK(system.client.find(first)->phase == OrderPhase::kReplaced);
  CHECK(system.client.find(second)->phase == OrderPhase::kAccepted);
  CHECK(system.book.drive_order(0, Rank::kClient)->order.goals[0].position_m == Vec2(2, 0));
}

}  // namespace sidestep::order_client_test
