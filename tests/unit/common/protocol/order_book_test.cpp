// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/order_book.hpp"

#include <algorithm>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::order_book_test {

constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);
constexpr auto kReferee = static_cast<ClientId>(Sender::kReferee);
constexpr ClientId kAnna = 1'000'001, kBert = 1'000'002;
constexpr std::array kClients{kAnna, kBert, kReferee, kOperator};

RememberedOrder order(msg::OrderKind kind, RobotId robot, ClientId client, OrderNumber number) {
  return {{kind, robot, client, number}};
}
RememberedOrder go(RobotId robot, ClientId client, OrderNumber number) {
  RememberedOrder remembered = order(msg::OrderKind::ORDER_GO, robot, client, number);
  remembered.order.goals.push_back({{1, 2}});
  return remembered;
}
RememberedOrder hold(RobotId robot, ClientId client, OrderNumber number) {
  return order(msg::OrderKind::ORDER_HOLD, robot, client, number);
}
RememberedOrder resume(RobotId robot, ClientId client, OrderNumber number) {
  return order(msg::OrderKind::ORDER_RESUME, robot, client, number);
}
RememberedOrder zone(ClientId client, std::uint32_t zone_number, OrderNumber number) {
  RememberedOrder remembered = order(msg::OrderKind::ORDER_ZONE, kAllRobots, client, number);
  remembered.order.zone_number = zone_number;
  return remembered;
}

/// Whether a robot is held, from the list of all orders: it has a hold after which neither the hold's owner
/// nor an operator has sent a resume for the robot.
bool reference_is_held(const std::vector<RememberedOrder>& orders, RobotId robot) {
  const auto concerns = [=](const Order& o) { return o.robot == robot || o.robot == kAllRobots; };
  return std::ranges::any_of(orders, [&](const RememberedOrder& h) {
    if (h.order.kind != msg::OrderKind::ORDER_HOLD || !concerns(h.order)) return false;
    return std::ranges::none_of(orders, [&](const RememberedOrder& r) {
      return r.order.kind == msg::OrderKind::ORDER_RESUME && concerns(r.order) &&
             r.order.number > h.order.number &&
             (r.order.client == h.order.client || r.order.client == kOperator);
    });
  });
}

/// The latest drive order or cancel of a rank for a robot, from the list of all orders.
const Order* reference_drive_order(const std::vector<RememberedOrder>& orders, RobotId robot, Rank rank) {
  const Order* last = nullptr;
  for (const RememberedOrder& o : orders) {
    const bool drives =
        o.order.kind == msg::OrderKind::ORDER_GO || o.order.kind == msg::OrderKind::ORDER_CANCEL;
    if (!drives || o.order.robot != robot || rank_of(o.order.client) != rank) continue;
    if (!last || std::pair(o.order.number, o.order.client) > std::pair(last->number, last->client))
      last = &o.order;
  }
  return last;
}

TEST_CASE("order books that merge the same orders in any sequence agree with each other and the reference") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    Rng rng(seed);
    std::vector<RememberedOrder> orders;
    for (int i = 0; i < 40; ++i) {
      const auto kind = static_cast<msg::OrderKind>(rng.below(4));
      const bool may_be_all = kind == msg::OrderKind::ORDER_HOLD || kind == msg::OrderKind::ORDER_RESUME;
      const RobotId robot = may_be_all && rng.below(3) == 0 ? kAllRobots : rng.below(3);
      // No client uses a number twice.
      const std::uint32_t client = rng.below(4);
      orders.push_back(
          order(kind, robot, kClients[client], 1 + 4 * static_cast<OrderNumber>(i / 2) + client));
      if (i % 2 == 1 && orders[i].order.number == orders[i - 1].order.number) orders.pop_back(), --i;
    }
    OrderBook first, second;
    for (const RememberedOrder& o : orders) first.merge(o);
    for (std::size_t i = orders.size(); i-- > 0;) {
      // The second book merges the orders in reverse, and some orders twice.
      second.merge(orders[i]);
      second.merge(orders[rng.below(static_cast<std::uint32_t>(orders.size()))]);
    }
    CHECK(first.missing_in(second).empty());
    CHECK(second.missing_in(first).empty());
    CHECK(first.all().size() == second.all().size());
    CHECK(first.hold_count() == second.hold_count());
    for (RobotId robot = 0; robot < 3; ++robot) {
      CHECK(first.is_held(robot) == reference_is_held(orders, robot));
      CHECK(first.is_held(robot) == !first.holds_of(robot).empty());
      CHECK(second.is_held(robot) == first.is_held(robot));
      for (std::size_t rank = 0; rank < kRanks; ++rank) {
        const Order* expected = reference_drive_order(orders, robot, static_cast<Rank>(rank));
        const RememberedOrder* found = second.drive_order(robot, static_cast<Rank>(rank));
        REQUIRE((found != nullptr) == (expected != nullptr));
        if (expected) CHECK((found->order.number == expected->number && found->order.kind == expected->kind));
      }
    }
  }
}

TEST_CASE("only a hold's owner or an operator can lift the hold, even for one robot of a hold of all") {
  OrderBook book;
  book.merge(hold(kAllRobots, kAnna, 10));
  book.merge(resume(kAllRobots, kBert, 11));
  book.merge(resume(kAllRobots, kReferee, 12));
  CHECK(book.is_held(3));
  book.merge(resume(3, kAnna, 13));
  CHECK_FALSE(book.is_held(3));
  CHECK(book.is_held(4));
  book.merge(hold(4, kBert, 14));
  book.merge(resume(kAllRobots, kOperator, 15));
  CHECK_FALSE(book.is_held(4));
  book.merge(resume(4, kOperator, 16));
  book.merge(hold(4, kOperator, 17));
  book.merge(resume(4, kReferee, 18));
  CHECK(book.is_held(4));
}

TEST_CASE("a book names the holds on a robot") {
  OrderBook book;
  book.merge(hold(3, kAnna, 10));
  book.merge(hold(kAllRobots, kBert, 11));
  book.merge(hold(4, kOperator, 12));
  const auto clients = [&](RobotId robot) {
    std::vector<ClientId> found;
    for (const Order& order : book.holds_of(robot)) found.push_back(order.client);
    return found;
  };
  CHECK(clients(3) == std::vector<ClientId>{kAnna, kBert});
  CHECK(clients(4) == std::vector<ClientId>{kOperator, kBert});
  CHECK(book.holds().size() == 3);
  book.merge(resume(3, kBert, 13));
  CHECK(clients(3) == std::vector<ClientId>{kAnna});
  CHECK(clients(5) == std::vector<ClientId>{kBert});
  book.merge(resume(kAllRobots, kOperator, 14));
  CHECK(book.holds().empty());
}

TEST_CASE("an order is identified by its number, and a late order changes nothing") {
  OrderBook book;
  CHECK(book.merge(go(3, kAnna, 10)) == OrderBook::Outcome::kStored);
  CHECK(book.merge(go(3, kAnna, 10)) == OrderBook::Outcome::kKnown);
  CHECK(book.merge(go(3, kBert, 9)) == OrderBook::Outcome::kReplaced);
  CHECK(book.merge(go(3, kBert, 11)) == OrderBook::Outcome::kStored);
  CHECK(book.merge(go(3, kOperator, 5)) == OrderBook::Outcome::kStored);  // operators' orders are separate
  CHECK(book.newest_number() == 11);
}

TEST_CASE("an order's progress never goes back, and a robot that begins an order leaves a finished order") {
  OrderBook book;
  book.merge(go(3, kAnna, 10));
  book.merge(go(3, kOperator, 11));
  CHECK(book.report(3, kOperator, 11, {msg::OrderState::ORDER_ARRIVED, 0}));
  CHECK_FALSE(book.report(3, kOperator, 11, {msg::OrderState::ORDER_DRIVING, 0}));
  CHECK_FALSE(
      book.report(3, 0, 0, {msg::OrderState::ORDER_ACCEPTED, 0}));  // from a new agent, which has no order
  CHECK(book.drive_order(3, Rank::kOperator)->progress.is_finished());
  CHECK(book.report(3, kAnna, 10, {msg::OrderState::ORDER_DRIVING, 0}));
  CHECK(book.drive_order(3, Rank::kOperator)->progress.state == msg::OrderState::ORDER_LEFT);
  CHECK_FALSE(book.report(3, kAnna, 9, {msg::OrderState::ORDER_ARRIVED, 0}));  // progress of an earlier order
  CHECK_FALSE(book.drive_order(3, Rank::kClient)->progress.is_finished());
  RememberedOrder further = go(3, kAnna, 10);
  further.progress = {msg::OrderState::ORDER_ARRIVED, 0};
  CHECK(book.merge(further) == OrderBook::Outcome::kStored);
  OrderBook other;
  other.merge(go(3, kAnna, 10));
  CHECK(book.missing_in(other).size() == 2);
  CHECK(other.missing_in(book).empty());
}

RememberedOrder removal(ClientId client, std::uint32_t zone_number, OrderNumber number) {
  RememberedOrder remembered = zone(client, zone_number, number);
  remembered.order.kind = msg::OrderKind::ORDER_REMOVE_ZONE;
  return remembered;
}

TEST_CASE("a zone stays until removed, and the numbers of zones and holds are bounded") {
  OrderBook book;
  book.merge(zone(kAnna, 1, 10));
  book.merge(zone(kBert, 1, 11));
  CHECK(book.zones().size() == 2);
  book.merge(removal(kAnna, 1, 12));
  CHECK(book.zones().size() == 1);
  CHECK(book.merge(zone(kAnna, 1, 10)) == OrderBook::Outcome::kReplaced);
  for (std::uint32_t i = 2; i < 1000; ++i) book.admit(zone(kAnna, i, 100 + i).order);
  CHECK(book.admit(zone(kBert, 7, 5000).order) == OrderBook::Outcome::kFull);
  CHECK(book.admit(zone(kBert, 1, 5000).order) == OrderBook::Outcome::kStored);  // replaces the same zone
  CHECK(book.zones().size() == OrderBook::kMaxZones);
  CHECK(book.admit(zone(kReferee, 7, 5000).order) == OrderBook::Outcome::kStored);
  for (std::uint32_t i = 0; i < 2000; ++i) book.admit(hold(5, kAnna + i, 100).order);
  CHECK(book.hold_count() == OrderBook::kMaxHolds);
  CHECK(book.admit(hold(kAllRobots, kOperator, 100).order) == OrderBook::Outcome::kStored);
  CHECK(book.is_held(1));
}

TEST_CASE("of two orders with the same number, the order of the client with the higher id wins") {
  for (const auto kind : {msg::OrderKind::ORDER_GO, msg::OrderKind::ORDER_CANCEL}) {
    const RememberedOrder of_anna = order(kind, 3, kAnna, 10), of_bert = go(3, kBert, 10);
    OrderBook first, second;
    CHECK(first.merge(of_anna) == OrderBook::Outcome::kStored);
    CHECK(first.merge(of_bert) == OrderBook::Outcome::kStored);
    CHECK(second.merge(of_bert) == OrderBook::Outcome::kStored);
    CHECK(second.merge(of_anna) == OrderBook::Outcome::kReplaced);
    for (const OrderBook* book : {&first, &second})
      CHECK(book->drive_order(3, Rank::kClient)->order.client == kBert);
    CHECK(first.missing_in(second).empty());
    CHECK(second.missing_in(first).empty());
  }
}

TEST_CASE("a resume lifts only holds with lower numbers") {
  for (const bool hold_is_first : {true, false}) {
    for (const RobotId scope : {RobotId{3}, kAllRobots}) {
      OrderBook book;
      if (hold_is_first) book.merge(hold(3, kAnna, 10));
      book.merge(resume(scope, kOperator, 10));
      if (!hold_is_first) book.merge(hold(3, kAnna, 10));
      CHECK(book.is_held(3));
      book.merge(resume(scope, kOperator, 11));
      CHECK_FALSE(book.is_held(3));
    }
  }
}

TEST_CASE("lifted holds and removed zones free their places permanently") {
  OrderBook book;
  OrderNumber number = 0;
  std::size_t most = 0;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const ClientId client = kAnna + i % 5000;
    const RobotId robot = i % 7 == 0 ? kAllRobots : i % 1000;
    CAPTURE(i);
    REQUIRE(book.admit(hold(robot, client, ++number).order) == OrderBook::Outcome::kStored);
    REQUIRE(book.admit(zone(client, i, ++number).order) == OrderBook::Outcome::kStored);
    REQUIRE(book.is_held(robot % 1000));
    REQUIRE(book.admit(resume(robot, client, ++number).order) == OrderBook::Outcome::kStored);
    REQUIRE(book.admit(removal(client, i, ++number).order) == OrderBook::Outcome::kStored);
    REQUIRE(book.hold_count() + book.zone_count() == 0);
    most = std::max(most, book.all().size());
  }
  CHECK(most <= OrderBook::kMaxResumes + OrderBook::kMaxRemovals);
}

TEST_CASE("the owner can lift any number of its holds, one by one or with one resume") {
  for (const bool all_at_once : {true, false}) {
    OrderBook book;
    OrderNumber number = 0;
    for (RobotId robot = 0; robot < OrderBook::kMaxHolds; ++robot)
      REQUIRE(book.admit(hold(robot, kAnna, ++number).order) == OrderBook::Outcome::kStored);
    REQUIRE(book.admit(hold(1000, kAnna, ++number).order) == OrderBook::Outcome::kFull);
    if (all_at_once) {
      REQUIRE(book.admit(resume(kAllRobots, kAnna, ++number).order) == OrderBook::Outcome::kStored);
    } else {
      for (RobotId robot = 0; robot < OrderBook::kMaxHolds; ++robot)
        REQUIRE(book.admit(resume(robot, kAnna, ++number).order) == OrderBook::Outcome::kStored);
    }
    CHECK(book.hold_count() == 0);
    CHECK(book.admit(hold(1000, kAnna, ++number).order) == OrderBook::Outcome::kStored);
  }
}

TEST_CASE("an operator's resume of all robots removes all holds and resumes of clients") {
  OrderBook book;
  for (RobotId robot = 0; robot < 200; ++robot) {
    book.merge(hold(robot, kAnna, 10 + robot));
    book.merge(resume(robot, kBert, 10 + robot));
  }
  book.merge(resume(kAllRobots, kOperator, 1000));
  CHECK(book.all().size() == 1);
  CHECK(book.merge(hold(7, kAnna, 999)) == OrderBook::Outcome::kReplaced);  // arrives late
  CHECK_FALSE(book.is_held(7));
}

TEST_CASE(
    "a late repetition of a lifted hold or a removed zone is refused, even after thousands of later ones") {
  OrderBook book;
  OrderNumber number = 100;
  const Order first_hold = hold(3, kAnna, ++number).order, first_zone = zone(kAnna, 0, ++number).order;
  book.admit(first_hold);
  book.admit(first_zone);
  for (std::uint32_t i = 0; i < 3 * OrderBook::kMaxResumes; ++i) {
    book.admit(resume(3, kAnna + i, ++number).order);
    book.admit(removal(kAnna, i, ++number).order);
    CHECK(book.admit(first_hold) == OrderBook::Outcome::kReplaced);
    CHECK(book.admit(first_zone) == OrderBook::Outcome::kReplaced);
  }
  CHECK_FALSE(book.is_held(3));
  CHECK(book.zones().empty());
  // New holds of clients and operators are admitted.
  CHECK(book.admit(hold(3, kAnna, ++number).order) == OrderBook::Outcome::kStored);
  CHECK(book.admit(hold(4, kOperator, 5).order) == OrderBook::Outcome::kStored);
}

TEST_CASE("a robot released from a hold of all robots stays released while many other holds are lifted") {
  OrderBook book;
  OrderNumber number = 0;
  book.admit(hold(kAllRobots, kAnna, ++number).order);
  book.admit(resume(5, kAnna, ++number).order);
  for (std::uint32_t i = 0; i < 2 * OrderBook::kMaxResumes; ++i)
    book.admit(resume(6, kBert + i, ++number).order);
  CHECK_FALSE(book.is_held(5));
  CHECK(book.is_held(6));
}

TEST_CASE("clients can release every robot of a large fleet one by one from a hold of all robots") {
  OrderBook book, other;
  OrderNumber number = 0;
  const ClientId third = kAnna + 7;
  const int clients = GENERATE(1, 2);
  for (int i = 0; i < clients; ++i)
    book.admit(hold(kAllRobots, kAnna + static_cast<ClientId>(i), ++number).order);
  for (RobotId robot = 0; robot < kMaxRobots; ++robot) {
    for (int i = 0; i < clients; ++i)
      REQUIRE(book.admit(resume(robot, kAnna + static_cast<ClientId>(i), ++number).order) ==
              OrderBook::Outcome::kStored);
  }
  const auto held_in = [](const OrderBook& some) {
    int held = 0;
    for (RobotId robot = 0; robot < kMaxRobots; ++robot) held += some.is_held(robot);
    return held;
  };
  CHECK(held_in(book) == 0);
  for (const RememberedOrder& order : book.all()) other.merge(order);
  CHECK(held_in(other) == 0);
  // A third client finds no space, reports this, and resumes all robots.
  if (clients < 2) return;
  book.admit(hold(kAllRobots, third, ++number).order);
  CHECK(book.admit(resume(3, third, ++number).order) == OrderBook::Outcome::kFull);
  CHECK(held_in(book) == static_cast<int>(kMaxRobots));
  CHECK(book.admit(resume(kAllRobots, third, ++number).order) == OrderBook::Outcome::kStored);
  CHECK(held_in(book) == 0);
  // Lifting kAnna's hold frees the space of its exceptions.
  CHECK(book.admit(resume(kAllRobots, kAnna, ++number).order) == OrderBook::Outcome::kStored);
  book.admit(hold(kAllRobots, third, ++number).order);
  CHECK(book.admit(resume(3, third, ++number).order) == OrderBook::Outcome::kStored);
  CHECK_FALSE(book.is_held(3));
}

TEST_CASE("the number of exceptions from holds of all robots that other processes remember is bounded") {
  OrderBook book;
  OrderNumber number = 0;
  for (ClientId i = 0; i < 5; ++i) {
    book.merge(hold(kAllRobots, kAnna + i, ++number));
    for (RobotId robot = 0; robot < kMaxRobots; ++robot) book.merge(resume(robot, kAnna + i, ++number));
  }
  CHECK(book.all().size() <= OrderBook::kMaxMergedExceptions + 5);
  CHECK(book.is_held(0));  // beyond the bound, a robot stays held
}

TEST_CASE("orders that another process remembers are accepted even if the order book is full") {
  OrderBook book;
  OrderNumber number = 0;
  for (RobotId robot = 0; robot < OrderBook::kMaxHolds; ++robot)
    book.admit(hold(robot, kAnna, ++number).order);
  for (std::uint32_t i = 0; i < OrderBook::kMaxZones; ++i) book.admit(zone(kAnna, i, ++number).order);
  CHECK(book.admit(hold(900, kBert, ++number).order) == OrderBook::Outcome::kFull);
  CHECK(book.merge(hold(900, kBert, number)) == OrderBook::Outcome::kStored);
  CHECK(book.is_held(900));
  CHECK(book.merge(zone(kBert, 1, ++number)) == OrderBook::Outcome::kStored);
  CHECK(book.zones().size() == OrderBook::kMaxZones + 1);
}

}  // namespace sidestep::order_book_test
