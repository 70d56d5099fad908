// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/robot_watch.hpp"

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::robot_watch_test {

using namespace std::chrono_literals;

constexpr RobotId kRobot = 3;
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);
constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);

Order hold_of(const char* client, OrderNumber number) {
  Order hold{msg::OrderKind::ORDER_HOLD, kRobot, client_id(client), number};
  hold.client_name = client_name(client);
  return hold;
}

/// A watch, and a process that reports as a robot, its agent and a coordinator do.
struct Scene {
  SimNetwork network{1, time_from_ns(1'000'000'000'000), NetworkSpec{}};
  SimBus watch_bus{network}, bus{network};
  OrderClient client{watch_bus, client_id("alice"), "alice"};
  RobotWatch watch;
  Writer<msg::Feedback> robot_writer = bus.advertise(topics::kFeedback, kRobot);
  Writer<msg::OrderStatus> order_writer = bus.advertise(topics::kOrderStatus);
  Writer<msg::AgentStatus> agent_writer = bus.advertise(topics::kStatus);
  Writer<msg::CoordinatorState> coordinator_writer = bus.advertise(topics::kCoordinator);
  Writer<msg::OrderMemory> memory_writer = bus.advertise(topics::kOrderMemory);
  OrderBook book;
  bool robot_reports = true, agent_reports = true, coordinator_reports = true, is_lifted = false,
       is_held = false;
  msg::AgentState agent_state = msg::AgentState::AGENT_DRIVING;
  msg::CoordinatorState coordinator;

  explicit Scene(bool has_keys = false) : watch(watch_bus, client, has_keys) {
    coordinator.header().sender(kCoordinator);
    coordinator.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
    coordinator.epoch(8);
    watch.watch_all();
  }
  void report_robot() {
    msg::Feedback message;
    message.robot(kRobot);
    message.header().sender(kRobot);
    message.is_lifted(is_lifted);
    robot_writer.publish(message, bus.now());
  }
  void report_agent() {
    OrderReport report{kRobot, kOperator, 5, {msg::OrderState::ORDER_DRIVING, 0}};
    report.is_held = is_held;
    msg::OrderStatus order = encode(report);
    order.header().sender(kRobot);
    order_writer.publish(order, bus.now());
    msg::AgentStatus agent;
    agent.robot(kRobot);
    agent.header().sender(kRobot);
    agent.agent_state(agent_state);
    agent_writer.publish(agent, bus.now());
  }
  void tell_memory() {
    for (msg::OrderMemory& page : encode(book.all(), true, false)) {
      page.process(kCoordinator);
      page.header().sender(kCoordinator);
      memory_writer.publish(page, bus.now());
    }
  }
  void name(RobotId robot, void (*set)(msg::RobotNotice&)) {
    msg::RobotNotice notice;
    notice.robot(robot);
    set(notice);
    coordinator.notices().push_back(notice);
  }
  void run(Duration duration) {
    for (const Time end = network.now() + duration; network.now() < end;) {
      if (robot_reports) report_robot();
      if (agent_reports) report_agent();
      if (coordinator_reports) coordinator_writer.publish(coordinator, bus.now());
      network.run_until(network.now() + 20ms);
    }
  }
  std::string text() const { return to_text(watch.hindrances(kRobot)); }
};

TEST_CASE("nothing hinders a robot at work") {
  Scene scene;
  CHECK(scene.text().empty());
  scene.run(5s);
  CHECK(scene.text().empty());
  CHECK(scene.watch.all_hindrances().empty());
  CHECK(scene.watch.is_complete());
}

TEST_CASE("a robot that is off the floor is recognised by its own report or by its agent's") {
  Scene scene;
  SECTION("the robot reports it") { scene.is_lifted = true; }
  SECTION("the agent reports it") { scene.agent_state = msg::AgentState::AGENT_ABSENT; }
  scene.run(100ms);
  CHECK(scene.text() == "it is off the floor");
  CHECK(scene.watch.hindrances(kRobot).front().state == "off floor");
}

TEST_CASE("a robot that sends no reports is silent, whether it was heard before or not") {
  Scene scene;
  scene.robot_reports = GENERATE(true, false);
  CAPTURE(scene.robot_reports);
  scene.run(100ms);
  CHECK(scene.watch.is_complete() == scene.robot_reports);
  scene.robot_reports = false;
  scene.run(800ms);
  CHECK(scene.text().empty());
  scene.run(11s);
  CHECK(scene.text() == "it has sent no report for 12 s");
  CHECK(scene.watch.hindrances(kRobot).front().state == "silent");
  CHECK(scene.watch.is_complete());
  scene.robot_reports = true;
  scene.run(100ms);
  CHECK(scene.text().empty());
}

TEST_CASE("an agent that sends no reports is silent") {
  Scene scene;
  scene.run(1s);
  scene.agent_reports = false;
  scene.run(2500ms);
  CHECK(scene.text().empty());
  scene.run(1500ms);
  CHECK(scene.text() == "its agent has sent no report for 4 s");
  CHECK(scene.watch.hindrances(kRobot).front().state == "no agent");
}

TEST_CASE("a process that hears neither coordinator nor agent says so, and with keys what may be the cause") {
  const bool has_keys = GENERATE(false, true);
  Scene scene(has_keys);
  scene.run(1s);
  scene.robot_reports = scene.agent_reports = scene.coordinator_reports = false;
  scene.run(2200ms);
  CHECK(scene.text() == "it has sent no report for 2 s");
  scene.run(2s);
  const std::string keys = has_keys ? "; this key may have been revoked" : "";
  CHECK(lasting_text(scene.watch.hindrances(kRobot)) ==
        "neither a coordinator nor its agent has been heard" + keys);
  CHECK(scene.text() == "neither a coordinator nor its agent has been heard for 4 s" + keys);
  scene.coordinator.coordinator_mode(msg::CoordinatorMode::COORDINATOR_STANDBY);
  scene.coordinator_reports = true;
  scene.run(100ms);
  CHECK_THAT(scene.text(), StartsWith("its agent has sent no report for 4 s"));
}

TEST_CASE("the holders of a robot are named once a coordinator has told them") {
  Scene scene;
  scene.is_held = true;
  scene.agent_state = msg::AgentState::AGENT_HELD;
  scene.run(2s);
  CHECK(scene.text() == "it is held");
  CHECK_FALSE(scene.watch.is_complete());
  (void)scene.book.merge({hold_of("bob", 5)});
  scene.tell_memory();
  scene.run(100ms);
  CHECK(scene.text() == "it is held by client bob");
  CHECK(scene.watch.is_complete());
  (void)scene.book.merge({{msg::OrderKind::ORDER_HOLD, kAllRobots, kOperator, 6}});
  (void)scene.book.merge({{msg::OrderKind::ORDER_HOLD, kRobot + 1, client_id("eve"), 6}});
  scene.tell_memory();
  scene.run(100ms);
  CHECK(scene.text() == "it is held by client bob and the operator");
}

TEST_CASE("every reason is named if there are several") {
  Scene scene;
  scene.is_held = scene.is_lifted = true;
  (void)scene.book.merge({hold_of("bob", 5)});
  scene.tell_memory();
  scene.run(1s);
  scene.robot_reports = false;
  scene.run(3s);
  CHECK(scene.text() == "it has sent no report for 3 s; it is off the floor; it is held by client bob");
  CHECK(lasting_text(scene.watch.hindrances(kRobot)) ==
        "it has sent no report; it is off the floor; it is held by client bob");
}

TEST_CASE("an agent that waits is named with its reason, unless it waits for a moment only") {
  Scene scene;
  scene.run(1s);
  scene.agent_state = msg::AgentState::AGENT_WAITING;
  scene.run(300ms);
  CHECK(scene.text().empty());
  scene.run(300ms);
  CHECK(scene.text() == "its agent waits for other robots, vision or a coordinator");
  SECTION("the coordinator waits for robots") {
    scene.name(7, [](msg::RobotNotice& notice) { notice.is_missing(true); });
    scene.name(9, [](msg::RobotNotice& notice) { notice.is_missing(true); });
    scene.run(100ms);
    CHECK(scene.text() == "the coordinator waits for robots 7, 9 to register");
  }
  SECTION("clocks differ") {
    scene.agent_state = msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND;
    scene.run(600ms);
    CHECK(scene.text() == "clocks differ by more than the safety budget allows");
  }
}

TEST_CASE("a robot to which nothing is granted is named with the reason") {
  Scene scene;
  SECTION("it is displaced") {
    scene.name(kRobot, [](msg::RobotNotice& notice) { notice.is_displaced(true); });
    scene.run(100ms);
    CHECK_THAT(scene.text(), StartsWith("it is displaced"));
  }
  SECTION("it is quarantined") {
    scene.name(kRobot, [](msg::RobotNotice& notice) { notice.is_quarantined(true); });
    scene.run(100ms);
    CHECK_THAT(scene.text(), StartsWith("it is quarantined"));
  }
  // A coordinator of a lower epoch does not decide.
  scene.coordinator.epoch(7);
  scene.coordinator.notices().clear();
  scene.run(500ms);
  CHECK_FALSE(scene.text().empty());
  scene.coordinator.epoch(16);
  scene.run(100ms);
  CHECK(scene.text().empty());
}

TEST_CASE("messages in the name of others change nothing") {
  Scene scene;
  scene.run(100ms);
  msg::AgentStatus agent;
  agent.robot(kRobot);
  agent.header().sender(kRobot + 1);
  agent.agent_state(msg::AgentState::AGENT_ABSENT);
  scene.agent_writer.publish(agent, scene.bus.now());
  agent.robot(kMaxRobots);
  agent.header().sender(kMaxRobots);
  scene.agent_writer.publish(agent, scene.bus.now());
  scene.agent_reports = false;
  scene.run(100ms);
  CHECK(scene.watch.all_hindrances().empty());
}

}  // namespace sidestep::robot_watch_test
