// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/event_watch.hpp"

#include "common/protocol/client_name.hpp"
#include "tests/catch.hpp"

namespace sidestep::event_watch_test {

using namespace std::chrono_literals;

struct Watched {
  EventLog log;
  EventWatch watch{log};
  FloorState floor;
  Time now = time_from_ns(1'000'000'000'000);

  std::string kinds() const {
    std::string all;
    for (const MonitorEvent& event : log.since(0)) all += event.kind + " ";
    return all;
  }
  template <typename Message>
  void hear(const Message& message) {
    watch.on(message, now);
    if constexpr (requires { floor.on(message, now); }) floor.on(message, now);
  }
};

TEST_CASE("each contact is one event, even if one message reports several contacts") {
  Watched w;
  msg::GroundTruth truth;
  truth.header().incarnation(1);
  w.hear(truth);
  CHECK(w.log.count() == 0);
  truth.contacts(3);
  truth.recent_contacts()[2].second(msg::NO_ROBOT);
  w.hear(truth);
  w.hear(truth);
  CHECK(w.kinds() == "contact contact contact ");
  CHECK(w.log.since(2)[0].text == "robot 0 touches an obstacle");
  // If a message reports more contacts than it lists, the listed contacts are events.
  truth.contacts(1'000'000);
  w.hear(truth);
  CHECK(w.log.count() == 3 + msg::MAX_CONTACTS);
  // The counts of a new simulator start from zero.
  truth.header().incarnation(2);
  truth.contacts(1);
  truth.crashes_while_moving(1);
  truth.firmware_violations(2);
  w.hear(truth);
  CHECK(w.log.count() == 3 + msg::MAX_CONTACTS + 3);
}

TEST_CASE("an agent that falls silent and returns causes two events") {
  Watched w;
  msg::AgentStatus status;
  status.robot(3);
  w.hear(status);
  w.now += 900ms;
  w.watch.tick(w.floor, w.now);
  CHECK(w.log.count() == 0);
  w.now += 200ms;
  w.watch.tick(w.floor, w.now);
  w.watch.tick(w.floor, w.now);
  CHECK(w.kinds() == "silent ");
  CHECK(w.log.since(0)[0].text == "agent 3 is silent");
  w.hear(status);
  w.watch.tick(w.floor, w.now);
  CHECK(w.kinds() == "silent heard ");
}

TEST_CASE("changes of robots, agents, orders and coordinators are events, but repetitions are not") {
  Watched w;
  msg::Feedback feedback;
  msg::AgentStatus status;
  msg::OrderStatus order;
  msg::CoordinatorState coordinator;
  for (int i = 0; i < 3; ++i) {
    w.hear(feedback);
    w.hear(order);
  }
  status.header().incarnation(5);
  w.hear(status);
  CHECK(w.kinds().empty());
  feedback.is_off_reference(true);
  order.is_held(true);
  status.header().incarnation(6);
  coordinator.epoch(7);
  coordinator.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  for (int i = 0; i < 3; ++i) {
    w.hear(feedback);
    w.hear(order);
    w.hear(status);
    w.hear(coordinator);
  }
  CHECK(w.kinds() == "off reference hold restart epoch ");
  order.block_reason(msg::BlockReason::BLOCK_NO_PATH);
  w.hear(order);
  order.block_reason(msg::BlockReason::BLOCK_NONE);
  w.hear(order);
  CHECK(w.kinds() == "off reference hold restart epoch blocked free ");
}

TEST_CASE("a refused order is an event with the reason, and an accepted or replaced one is none") {
  Watched w;
  msg::OrderAnswer answer;
  answer.client(static_cast<std::uint32_t>(Sender::kOperator));
  for (const msg::OrderResult result :
       {msg::OrderResult::RESULT_REMEMBERED, msg::OrderResult::RESULT_REPLACED,
        msg::OrderResult::RESULT_OUTSIDE_FIELD, msg::OrderResult::RESULT_UNKNOWN_ROBOT}) {
    answer.result(result);
    w.hear(answer);
  }
  REQUIRE(w.kinds() == "order order ");
  CHECK(w.log.since(0)[0].text == "an order from the operator was refused: a goal is outside the field");
  CHECK(w.log.since(0)[1].text == "an order from the operator was refused: the scenario has no such robot");
}

TEST_CASE("events about orders name their client") {
  Watched w;
  msg::OrderAnswer answer;
  answer.client(client_id("kitchen"));
  answer.result(msg::OrderResult::RESULT_OUTSIDE_FIELD);
  w.hear(answer);
  msg::Order order;
  order.header().sender(client_id("kitchen"));
  order.robot(3);
  order.terms().order_kind(msg::OrderKind::ORDER_GO);
  order.terms().order_number(5);
  order.terms().client_name(client_name("kitchen"));
  w.hear(order);
  w.hear(answer);
  // Anybody could claim another client's name.
  order.header().sender(client_id("garden"));
  w.hear(order);
  order.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
  order.terms().client_name({});
  w.hear(order);
  std::vector<std::string> texts;
  for (const MonitorEvent& event : w.log.since(0)) texts.push_back(event.text);
  const std::string refused = " was refused: a goal is outside the field";
  CHECK(texts == std::vector<std::string>{
                     "an order from client " + std::to_string(client_id("kitchen")) + refused,
                     "client kitchen sends robot 3 to a goal", "an order from client kitchen" + refused,
                     "client " + std::to_string(client_id("garden")) + " sends robot 3 to a goal",
                     "the operator sends robot 3 to a goal"});
}

TEST_CASE("a disturbance that the simulator refuses causes an event with the reason") {
  Watched w;
  msg::DisturbanceAnswer answer;
  answer.robot(5);
  answer.result(msg::DisturbanceResult::FAULT_APPLIED);
  w.hear(answer);
  CHECK(w.log.count() == 0);
  answer.result(msg::DisturbanceResult::FAULT_ON_FLOOR);
  w.hear(answer);
  CHECK(w.kinds() == "disturbance ");
  CHECK(w.log.since(0)[0].text == "a disturbance of robot 5 was refused: robot 5 is on the floor");
}

TEST_CASE("impossible values in messages do no harm") {
  Watched w;
  msg::Feedback feedback;
  feedback.robot(4'000'000'000);
  feedback.is_lifted(true);
  w.hear(feedback);
  msg::Order order;
  order.terms().order_kind(static_cast<msg::OrderKind>(77));
  w.hear(order);
  msg::OrderAnswer answer;
  answer.result(static_cast<msg::OrderResult>(99));
  w.hear(answer);
  msg::Disturbance disturbance;
  disturbance.disturbance_kind(static_cast<msg::DisturbanceKind>(99));
  w.hear(disturbance);
  msg::DisturbanceAnswer refused;
  refused.result(static_cast<msg::DisturbanceResult>(99));
  w.hear(refused);
  msg::CoordinatorState coordinator;
  coordinator.coordinator_mode(static_cast<msg::CoordinatorMode>(99));
  coordinator.role_reason(static_cast<msg::RoleReason>(99));
  coordinator.epoch(3);
  w.hear(coordinator);
  CHECK(w.kinds() == "epoch ");
}

TEST_CASE("a flood of orders from made-up senders causes few events") {
  Watched w;
  msg::Order order;
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    order.header().sender(1'000'000 + i);
    order.terms().order_number(i + 1);
    w.hear(order);
    w.now += 100us;
  }
  CHECK(w.log.count() <= 2'100);
  // Later events are logged, and repetitions are not.
  w.now += 60s;
  const std::uint64_t before = w.log.count();
  w.hear(order);
  order.terms().order_number(7);
  w.hear(order);
  w.hear(order);
  CHECK(w.log.count() == before + 1);
}

TEST_CASE("a flood of made-up senders with different rules causes few events and hides no later event") {
  Watched w;
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    w.watch.on_refused(1'000'000 + i, w.now);
    w.now += 100us;
  }
  CHECK(w.log.count() <= 2'100);
  w.now += 60s;
  const std::uint64_t before = w.log.count();
  for (int i = 0; i < 3; ++i) w.watch.on_refused(3, w.now);
  CHECK(w.log.count() == before + 1);
  CHECK(w.log.since(before)[0].text == "agent 3 has different rules: its messages are refused");
}

TEST_CASE("a full event log forgets the oldest events, and numbering continues") {
  EventLog log;
  for (std::size_t i = 0; i < EventLog::kMaxEvents + 10; ++i) log.add({0, {}, Severity::kInfo, "x", "", {}});
  CHECK(log.since(0).size() == EventLog::kMaxEvents);
  CHECK(log.since(0).front().number == 11);
  CHECK(log.count() == EventLog::kMaxEvents + 10);
}

}  // namespace sidestep::event_watch_test
