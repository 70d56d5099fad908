// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent_event_logger.hpp"

#include "agents/agent/agent_node.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"
#include "tests/log_events.hpp"

namespace sidestep::agent_event_logger_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

/// Passes an agent's activity to the logger once per cycle.
struct Fixture {
  EventReporter reporter;
  AgentEventLogger changes{reporter, 3};
  AgentActivity activity;
  ClockSpeedLimit limit{2, 2, OffsetInterval{Duration{-1000}, Duration{1000}}};
  Time now = kBegin;
  LogEvents events{*this};

  void on_event(LogLevel level, OnLogEvent callback) { reporter.set_listener(level, std::move(callback)); }
  void run(Duration duration) {
    const Time end = now + duration;
    for (; now < end; now += 16ms) changes.update(activity, limit, now);
  }
};

TEST_CASE("each step of an agent's startup is reported once") {
  Fixture f;
  f.run(100ms);
  CHECK(f.events.all().empty());
  f.activity.is_fenced = true;
  f.activity.incarnation = 99;
  f.run(100ms);
  CHECK(f.events.count("the robot obeys this agent (incarnation 99)") == 1);
  f.changes.on_epoch(7, 10001);
  f.activity.epoch = 7;
  f.run(100ms);
  CHECK(f.events.count("epoch 7 of coordinator 1") == 1);
  f.changes.on_epoch(8, std::nullopt);
  CHECK(f.events.count("adopted epoch 8, which the robot already obeys") == 1);
  f.activity.epoch = 8;
  f.activity.is_registered = true;
  f.run(1s);
  CHECK(f.events.count("registered in epoch 8") == 1);
  f.activity.epoch = 9;
  f.run(1s);
  CHECK(f.events.count("registered in epoch 9") == 1);
  CAPTURE(f.events.text());
  CHECK(f.events.all().size() == 5);
  for (const LogEvent& event : f.events.all()) CHECK(event.robot == 3);
}

TEST_CASE("an agent reports when its robot stops obeying it and when the robot obeys it again") {
  Fixture f;
  f.activity.is_superseded = true;
  f.run(1s);
  CHECK(f.events.count("a later agent drives this robot") == 1);
  f.activity.is_superseded = false;
  f.run(1s);
  CHECK(f.events.count("no longer superseded: the robot obeys this agent") == 1);
}

TEST_CASE("a wait of more than a quarter of a second is reported with its reason, and its end is reported") {
  for (int i = 1; i <= static_cast<int>(WaitReason::kClockOutOfBound); ++i) {
    const auto reason = static_cast<WaitReason>(i);
    CAPTURE(to_text(reason));
    Fixture f;
    f.activity.waits_for = reason;
    f.run(200ms);
    CHECK(f.events.all().empty());
    f.run(5s);
    CHECK(f.events.count("waiting for " + std::string(to_text(reason))) == 1);
    f.activity.waits_for = WaitReason::kNone;
    f.run(5s);
    CHECK(f.events.count("no longer waiting") == 1);
    CHECK(f.events.all().size() == 2);
  }
}

TEST_CASE("a reason to wait that comes and goes in every cycle is not reported") {
  Fixture f;
  for (int i = 0; i < 1000; ++i) {
    f.activity.waits_for = i % 2 == 0 ? WaitReason::kRobotSilent : WaitReason::kNone;
    f.run(16ms);
  }
  CHECK(f.events.all().empty());
}

TEST_CASE("a speed limit due to the clocks is reported when it begins, changes considerably or ends") {
  Fixture f;
  f.run(2s);
  CHECK(f.events.all().empty());
  f.limit = {0.5, 2, OffsetInterval{4ms, 6ms}};
  f.run(5s);
  CHECK(f.events.count("the clocks limit the speed to 0.50 m/s: they differ by 5.00 +- 1.00 ms") == 1);
  f.limit.speed_mps = 0.55;
  f.run(5s);
  CHECK(f.events.all().size() == 1);
  f.limit.speed_mps = 1;
  f.run(5s);
  CHECK(f.events.count("to 1.00 m/s") == 1);
  f.limit.speed_mps = 2;
  f.run(5s);
  CHECK(f.events.count("the clocks no longer limit the speed") == 1);
  CHECK(f.events.all().size() == 3);
}

TEST_CASE("arrivals are reported, and escapes and deadlock recoveries are reported at most once per second") {
  Fixture f;
  f.activity.goal_index = 1;
  f.run(1s);
  CHECK(f.events.count("arrived at goal 0") == 1);
  f.activity.has_arrived = true;
  f.run(1s);
  CHECK(f.events.count("arrived at goal 1, the last goal") == 1);
  for (int i = 0; i < 200; ++i) {
    f.activity.is_escaping = f.activity.is_recovering = i % 2 == 0;
    f.run(16ms);
  }
  CAPTURE(f.events.text());
  CHECK(f.events.count("escaping from a conflict") == 4);
  CHECK(f.events.count("to resolve the deadlock") == 4);
}

TEST_CASE("each own stop, restart and lifting of the robot is reported once") {
  Fixture f;
  RobotReport robot_report;
  robot_report.valid_at = kBegin;
  robot_report.activated = 5;
  f.changes.on_robot_report(robot_report);
  CHECK(f.events.all().empty());
  robot_report.is_off_reference = true;
  robot_report.executing.number = 1234;
  for (int i = 0; i < 5; ++i) f.changes.on_robot_report(robot_report);
  CHECK(f.events.count("off its reference and makes its own stop (version 1234)") == 1);
  robot_report.activated = 0;
  robot_report.executing.number = 5678;
  for (int i = 0; i < 5; ++i) f.changes.on_robot_report(robot_report);
  CHECK(f.events.count("version 5678") == 1);
  CHECK(f.events.count("firmware has restarted") == 1);
  robot_report.is_off_reference = false;
  for (int i = 0; i < 5; ++i) f.changes.on_robot_report(robot_report);
  CHECK(f.events.count("back on a granted version") == 1);
  robot_report.is_lifted = true;
  for (int i = 0; i < 5; ++i) f.changes.on_robot_report(robot_report);
  CHECK(f.events.count("is off the floor") == 1);
  robot_report.is_lifted = false;
  for (int i = 0; i < 5; ++i) f.changes.on_robot_report(robot_report);
  CHECK(f.events.count("has been put down") == 1);
  const std::size_t before = f.events.all().size();
  robot_report.valid_at -= 1ms;  // a fact that arrives after a newer fact
  robot_report.is_lifted = true;
  f.changes.on_robot_report(robot_report);
  CHECK(f.events.all().size() == before);
  robot_report.valid_at -= 10s;  // the robot's clock was set back, which raises its incarnation
  ++robot_report.robot_incarnation;
  f.changes.on_robot_report(robot_report);
  CHECK(f.events.count("is off the floor") == 2);
}

TEST_CASE("a late report of the robot's earlier incarnation is not logged as another restart") {
  const Scenario scenario = parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n  - {id: 3, start_m: [0, 0]}\n", "one-robot.yaml");
  SimNetwork network(1, kBegin, scenario.network);
  SimBus agent_bus(network), robot_bus(network);
  AgentNode node(agent_bus, scenario, 3, 1000, std::make_shared<PlanningScratch>(scenario));
  LogEvents events(node);
  auto reports = robot_bus.advertise(topics::kFeedback, 3);
  const auto report = [&](Incarnation incarnation, std::uint64_t activated) {
    RobotReport robot_report;
    robot_report.robot = 3;
    robot_report.robot_incarnation = incarnation;
    robot_report.valid_at = network.now();
    robot_report.executing = {3, 0, 0, 0, Trajectory::resting(kBegin, {0, 0})};
    robot_report.activated = activated;
    auto message = encode(robot_report);
    reports.publish(message, network.now());
    network.run_until(network.now() + 10ms);
  };
  report(5, 7);
  report(6, 0);
  CHECK(events.count("firmware has restarted") == 1);
  // By then the earlier incarnation may speak again, as after a restart.
  network.run_until(network.now() + SingleWriterGuard::kGoneAfter);
  report(5, 7);
  report(6, 0);
  CHECK(events.count("firmware has restarted") == 1);
}

TEST_CASE("denials are counted by reason and reported at most once per second, at debug level") {
  Fixture f;
  Verdict denial;
  denial.reasons.fill(msg::Reason::REASON_NOT_EVALUATED);
  for (int i = 0; i < 60; ++i) {
    denial.reasons.front() = i % 3 == 0 ? msg::Reason::REASON_OBSTACLE : msg::Reason::REASON_CONFLICT;
    denial.blockers.front() = 7;
    f.changes.on_denial(denial);
    f.run(16ms);
  }
  f.run(1s);
  CAPTURE(f.events.text());
  CHECK(f.events.all().size() == 2);
  CHECK(f.events.count("40 x conflict (last with robot 7)") == 1);
  for (const LogEvent& event : f.events.all()) CHECK(event.level == LogLevel::kDebug);
}

TEST_CASE("a robot that a stranger keeps from driving is not reported as in a deadlock") {
  Fixture f;
  f.activity.stranger = Blockage{msg::BlockReason::BLOCK_STRANGER, 0, {0.25, 0}, {0, 0}, 1.5};
  f.activity.is_recovering = true;
  f.run(3s);
  CHECK(f.events.count("blocked: a stranger 0.25 m away, who may move at 1.5 m/s") == 1);
  CHECK(f.events.count("deadlock") == 0);
  f.activity.stranger.reset();
  f.run(3s);
  CHECK(f.events.count("blocked: turning right to resolve the deadlock") == 1);
}

}  // namespace sidestep::agent_event_logger_test
