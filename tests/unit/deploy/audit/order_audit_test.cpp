// SPDX-License-Identifier: Apache-2.0
// Histories with orders, in which one detail is modified.
#include <algorithm>
#include <set>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::order_audit_test {

using namespace std::chrono_literals;

constexpr auto kOperator = static_cast<std::uint32_t>(Sender::kOperator);
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);
constexpr std::uint32_t kClient = 1'000'001;
constexpr RobotId kHeldRobot = 2;

msg::RememberedOrder remembered(msg::OrderKind kind, std::uint32_t robot, std::uint32_t client,
                                std::uint64_t number) {
  msg::RememberedOrder order;
  order.robot(robot);
  order.client(client);
  order.terms().order_kind(kind);
  order.terms().order_number(number);
  return order;
}

void add(msg::OrderMemory& page, const msg::RememberedOrder& order) {
  page.orders()[page.order_count()] = order;
  page.order_count(static_cast<std::uint8_t>(page.order_count() + 1));
}

/// Adds these orders to all memories of the coordinator.
void remember(MessageHistory& h, const std::vector<msg::RememberedOrder>& orders) {
  h.each<msg::OrderMemory>([&](msg::OrderMemory& page, Time) {
    if (page.process() < kCoordinator || page.page_count() == 0) return;
    for (const msg::RememberedOrder& order : orders) add(page, order);
  });
}

/// Adds an order that a client gives early in the run and that the coordinator confirms.
void confirm(MessageHistory& h, const msg::RememberedOrder& order) {
  msg::CoordinatorState state;
  h.each<msg::CoordinatorState>([&](msg::CoordinatorState& s, Time) {
    if (state.header().sender() == 0) state = s;
  });
  msg::Order sent;
  sent.robot(order.robot());
  sent.header().sender(order.client());
  sent.terms(order.terms());
  msg::OrderAnswer answer;
  answer.header(state.header());
  answer.client(order.client());
  answer.order_number(order.terms().order_number());
  answer.result(msg::OrderResult::RESULT_REMEMBERED);
  const Time at = h.messages.front().at + 500ms;
  const auto place = std::ranges::find_if(h.messages, [&](const auto& m) { return m.at >= at; });
  answer.header().stamp_ns(to_ns(at));
  h.messages.insert(place, {{at, sent}, {at, answer}});
}

std::uint64_t violations(AuditRule rule, const std::function<void(MessageHistory&)>& tamper) {
  const AuditTotals totals = audit_tampered_crossing(tamper);
  UNSCOPED_INFO(lines(totals));
  return count(totals, rule);
}

TEST_CASE("a grant to a robot breaks a rule while the coordinator remembers a hold of the robot") {
  const auto hold = [](std::uint32_t robot) {
    return remembered(msg::OrderKind::ORDER_HOLD, robot, kClient, 1000);
  };
  const auto resume = [](std::uint32_t robot, std::uint32_t client, std::uint64_t number) {
    return remembered(msg::OrderKind::ORDER_RESUME, robot, client, number);
  };
  const auto held = [](std::vector<msg::RememberedOrder> orders) {
    const AuditTotals totals = audit_tampered_crossing([&](MessageHistory& h) { remember(h, orders); });
    std::set<RobotId> robots;
    for (const Violation& violation : totals.first) {
      if (violation.rule == AuditRule::kHeld) robots.insert(violation.robot);
    }
    return robots.size();
  };
  CHECK(held({}) == 0);
  CHECK(held({hold(kHeldRobot)}) == 1);
  CHECK(held({hold(msg::ALL_ROBOTS)}) == crossing().scenario.robots.size());
  // A robot that its owner or an operator has resumed from a hold of all robots may drive.
  CHECK(held({hold(msg::ALL_ROBOTS), resume(kHeldRobot, kClient, 1001)}) ==
        crossing().scenario.robots.size() - 1);
  CHECK(held({hold(msg::ALL_ROBOTS), resume(kHeldRobot, kOperator, 1001)}) ==
        crossing().scenario.robots.size() - 1);
  CHECK(held({hold(msg::ALL_ROBOTS), resume(kHeldRobot, kClient + 1, 1001)}) ==
        crossing().scenario.robots.size());
  CHECK(held({hold(msg::ALL_ROBOTS), resume(kHeldRobot, kClient, 999)}) == crossing().scenario.robots.size());
}

TEST_CASE("a grant between two holds breaks no rule if the first hold was lifted") {
  std::uint64_t number = 1000;
  CHECK(violations(AuditRule::kHeld, [&](MessageHistory& h) {
          h.each<msg::OrderMemory>([&](msg::OrderMemory& page, Time) {
            if (page.process() < kCoordinator || page.page_count() == 0) return;
            add(page, remembered(msg::OrderKind::ORDER_HOLD, kHeldRobot, kClient, ++number));
          });
        }) == 0);
}

TEST_CASE("a grant before a hold breaks no rule if a clock set back makes the grant seem later") {
  // The hold begins after the last grant, while the clock is behind for a second.
  const auto held = [](Duration set_back) {
    return violations(AuditRule::kHeld, [&](MessageHistory& h) {
      Time last_grant{};
      h.each<msg::Verdict>([&](msg::Verdict& verdict, Time at) {
        if (verdict.granted_version() != 0) last_grant = at;
      });
      const auto is_after = [&](Time at) { return at > last_grant; };
      REQUIRE(is_after(h.messages.back().at - 500ms));
      const auto set = [&](auto& message, Time at) {
        const bool is_behind = is_after(at) && !is_after(at - 1s);
        if (is_behind) message.header().stamp_ns(message.header().stamp_ns() - set_back.count());
      };
      h.each<msg::Verdict>(set);
      h.each<msg::CoordinatorState>(set);
      h.each<msg::OrderMemory>([&](msg::OrderMemory& page, Time at) {
        if (page.process() < kCoordinator) return;
        set(page, at);
        if (is_after(at) && page.page_count() > 0)
          add(page, remembered(msg::OrderKind::ORDER_HOLD, kHeldRobot, kClient, 1000));
      });
    });
  };
  CHECK(held(0s) == 0);
  CHECK(held(10s) == 0);
}

TEST_CASE("a coordinator that forgets a confirmed order breaks a rule unless a later order replaces it") {
  const auto forgotten = [](const msg::RememberedOrder& order, std::vector<msg::RememberedOrder> kept) {
    return violations(AuditRule::kForgottenOrder, [&](MessageHistory& h) {
      confirm(h, order);
      remember(h, kept);
    });
  };
  const auto hold = remembered(msg::OrderKind::ORDER_HOLD, 99, kClient, 1000);
  const auto go = remembered(msg::OrderKind::ORDER_GO, 99, kClient, 1000);
  auto zone = remembered(msg::OrderKind::ORDER_ZONE, msg::ALL_ROBOTS, kClient, 1000);
  zone.terms().zone(7);
  auto removal = zone, other_zone = zone;
  removal.terms().order_kind(msg::OrderKind::ORDER_REMOVE_ZONE);
  removal.terms().order_number(1001);
  other_zone.terms().zone(8);
  for (const auto& order : {hold, go, zone}) {
    CHECK(forgotten(order, {}) == 1);
    CHECK(forgotten(order, {order}) == 0);
  }
  CHECK(forgotten(hold, {remembered(msg::OrderKind::ORDER_RESUME, 99, kClient, 1001)}) == 0);
  CHECK(forgotten(hold, {remembered(msg::OrderKind::ORDER_RESUME, msg::ALL_ROBOTS, kOperator, 1001)}) == 0);
  CHECK(forgotten(hold, {remembered(msg::OrderKind::ORDER_RESUME, 99, kClient, 999)}) == 1);
  CHECK(forgotten(hold, {remembered(msg::OrderKind::ORDER_RESUME, 99, kClient + 1, 1001)}) == 1);
  CHECK(forgotten(hold, {remembered(msg::OrderKind::ORDER_HOLD, 99, kClient, 1002)}) == 0);
  CHECK(forgotten(go, {remembered(msg::OrderKind::ORDER_CANCEL, 99, kClient + 1, 1001)}) == 0);
  CHECK(forgotten(go, {remembered(msg::OrderKind::ORDER_GO, 99, kClient, 999)}) == 1);
  CHECK(forgotten(go, {remembered(msg::OrderKind::ORDER_GO, 99, kOperator, 1001)}) == 1);
  const auto resume = [](std::uint32_t robot, std::uint32_t client, std::uint64_t number) {
    return remembered(msg::OrderKind::ORDER_RESUME, robot, client, number);
  };
  const auto hold_all = [](std::uint32_t client, std::uint64_t number) {
    return remembered(msg::OrderKind::ORDER_HOLD, msg::ALL_ROBOTS, client, number);
  };
  CHECK(forgotten(resume(99, kClient, 1000), {}) == 0);
  CHECK(forgotten(resume(99, kClient, 1000), {hold_all(kClient, 999)}) == 1);
  CHECK(forgotten(resume(msg::ALL_ROBOTS, kClient, 1000), {hold_all(kClient + 1, 999)}) == 0);
  CHECK(forgotten(resume(99, kClient, 1000), {hold_all(kClient, 1000)}) == 0);
  CHECK(forgotten(resume(99, kClient, 1000), {hold_all(kClient + 1, 999)}) == 0);
  CHECK(forgotten(resume(99, kClient, 1000), {hold_all(kClient, 999), resume(99, kOperator, 1000)}) == 0);
  CHECK(forgotten(resume(99, kClient, 1000), {hold_all(kClient, 999), resume(98, kClient, 1000)}) == 1);
  CHECK(forgotten(zone, {removal}) == 0);
  CHECK(forgotten(zone, {other_zone}) == 1);
}

TEST_CASE("an order memory with a missing page is not judged") {
  CHECK(violations(AuditRule::kForgottenOrder, [](MessageHistory& h) {
          confirm(h, remembered(msg::OrderKind::ORDER_HOLD, 99, kClient, 1000));
          h.each<msg::OrderMemory>([](msg::OrderMemory& page, Time) {
            if (page.page_count() > 0) page.page_count(page.page_count() + 1);
          });
        }) == 0);
}

/// Robot kHeldRobot is held and a robot is sent to a goal before the active of two coordinators dies.
const MessageHistory& taken_over() {
  static const MessageHistory history = [] {
    Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml");
    scenario.coordinators = 2;
    return history_of(scenario, 3, [&](SimSystem& system) {
      OrderNumber number = 0;
      const auto send = [&](msg::OrderKind kind, RobotId robot) {
        number = std::max(number + 1, static_cast<OrderNumber>(to_ns(system.now())));
        Order order{kind, robot, kClient, number};
        if (kind == msg::OrderKind::ORDER_GO) order.goals = {{scenario.robots[1].start_m}};
        system.send(order);
      };
      system.run_for(2500ms);
      send(msg::OrderKind::ORDER_HOLD, kHeldRobot);
      send(msg::OrderKind::ORDER_GO, 1);
      system.run_for(1500ms);
      system.kill("coordinator");
      system.run_for(3s);
    });
  }();
  return history;
}

std::uint64_t violations_after_takeover(const std::function<void(MessageHistory&)>& tamper) {
  MessageHistory history = taken_over();
  tamper(history);
  const AuditTotals totals = audit_of(history, kComplete);
  UNSCOPED_INFO(lines(totals));
  return count(totals, AuditRule::kForgottenOrder);
}

/// Removes the client's orders of this kind from all memories of coordinator 1.
void forget(MessageHistory& h, msg::OrderKind kind) {
  h.each<msg::OrderMemory>([&](msg::OrderMemory& page, Time) {
    if (page.process() != kCoordinator + 1) return;
    const auto end = page.orders().begin() + page.order_count();
    const auto kept = std::remove_if(page.orders().begin(), end, [&](const msg::RememberedOrder& order) {
      return order.client() == kClient && order.terms().order_kind() == kind;
    });
    page.order_count(static_cast<std::uint8_t>(kept - page.orders().begin()));
  });
}

TEST_CASE("a new coordinator that does not remember an order that an agent remembers breaks a rule") {
  CHECK(violations_after_takeover([](MessageHistory&) {}) == 0);
  for (const auto kind : {msg::OrderKind::ORDER_HOLD, msg::OrderKind::ORDER_GO}) {
    CAPTURE(static_cast<int>(kind));
    CHECK(violations_after_takeover([&](MessageHistory& h) { forget(h, kind); }) == 1);
    // The agents have restarted, so no agent is known to have announced the order to the coordinator.
    CHECK(violations_after_takeover([&](MessageHistory& h) {
            forget(h, kind);
            h.remove_if<msg::OrderStatus>([](const msg::OrderStatus&) { return true; });
            h.remove_if<msg::OrderMemory>(
                [](const msg::OrderMemory& m) { return m.process() < kCoordinator; });
          }) == 0);
  }
}

TEST_CASE("an incompletely received history with orders raises no false alarm") {
  const std::uint64_t seed = GENERATE(range(std::uint64_t{1}, std::uint64_t{13}));
  const double loss = GENERATE(0.0, 0.1, 0.3, 0.7);
  CAPTURE(seed, loss);
  const AuditTotals totals = audit_of(degraded(taken_over(), seed, loss, Duration{0}), {});
  INFO(lines(totals));
  CHECK(count(totals, AuditRule::kHeld) == 0);
  CHECK(count(totals, AuditRule::kForgottenOrder) == 0);
}

}  // namespace sidestep::order_audit_test
