// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/simulator_node.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "common/messaging/robot_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/protocol/report_period.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/log_events.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::simulator_node_test {

using std::chrono::milliseconds;
using test::separated_robots;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

// The simulator and a second process that receives all its messages.
struct Scene {
  explicit Scene(const Scenario& s, std::uint64_t seed = 1)
      : scenario(s),
        network(seed, kBegin, s.network),
        bus(network),
        node(bus, scenario, 77, seed),
        outside(network) {
    for (const RobotSpec& robot : scenario.robots) {
      commands.push_back(outside.advertise(topics::kCommand, robot.id));
      outside.subscribe<msg::Feedback>(topics::kFeedback, robot.id,
                                       [this](const msg::Feedback& robot_report) {
                                         robot_reports[robot_report.robot()].push_back(robot_report);
                                         heard_at[robot_report.robot()].push_back(network.now());
                                       });
    }
    outside.subscribe<msg::DetectionFrame>(
        topics::kDetections, [this](const msg::DetectionFrame& frame) { frames.push_back(frame); });
    outside.subscribe<msg::GroundTruth>(topics::kTruth,
                                        [this](const msg::GroundTruth& t) { truths.push_back(t); });
  }

  void send(std::size_t robot, msg::Command message) { commands[robot].publish(message, network.now()); }
  void send(std::size_t robot, const Command& command) { send(robot, encode(command)); }
  void run(Duration time) { network.run_until(network.now() + time); }

  Scenario scenario;
  SimNetwork network;
  SimBus bus;
  SimulatorNode node;
  SimBus outside;
  std::vector<Writer<msg::Command>> commands;
  std::map<RobotId, std::vector<msg::Feedback>> robot_reports;
  std::map<RobotId, std::vector<Time>> heard_at;
  std::vector<msg::DetectionFrame> frames;
  std::vector<msg::GroundTruth> truths;
};

Vec2 scenario_start(const Scene& scene, std::size_t robot) { return scene.scenario.robots[robot].start_m; }

TEST_CASE("every idle robot reports about once per cycle, and not all robots at the same time") {
  Scene scene(separated_robots(10));
  scene.run(std::chrono::seconds(2));
  std::map<std::int64_t, int> burst;
  for (const auto& [robot, robot_reports] : scene.robot_reports) {
    CAPTURE(robot);
    CHECK(robot_reports.size() >= 90);
    CHECK(robot_reports.size() <= 125);
    for (std::size_t i = 1; i < robot_reports.size(); ++i) {
      CHECK(robot_reports[i].valid_at_ns() - robot_reports[i - 1].valid_at_ns() <= 21'000'000);
      CHECK(robot_reports[i].header().message_number() == robot_reports[i - 1].header().message_number() + 1);
    }
    CHECK(robot_reports.back().header().sender() == robot);
    CHECK(robot_reports.back().header().incarnation() == 77);
    for (const auto& robot_report : robot_reports) ++burst[robot_report.valid_at_ns()];
  }
  CHECK(scene.robot_reports.size() == 10);
  for (const auto& [time, count] : burst) CHECK(count <= 5);
}

TEST_CASE("the reports of idle robots are at most as far apart as robots may report, at any control rate") {
  Scenario scenario = separated_robots(3);
  const int rate_hz = GENERATE(5, 30, 60, 100, 500);
  scenario.cycle = from_seconds(1.0 / rate_hz);
  CAPTURE(rate_hz);
  Scene scene(scenario);
  scene.run(std::chrono::seconds(3));
  CHECK(scene.robot_reports.size() == 3);
  for (const auto& [robot, robot_reports] : scene.robot_reports) {
    REQUIRE(robot_reports.size() > 10);
    for (std::size_t i = 1; i < robot_reports.size(); ++i)
      CHECK(Duration{robot_reports[i].valid_at_ns() - robot_reports[i - 1].valid_at_ns()} <=
            max_report_gap(scenario.cycle));
  }
}

TEST_CASE("a switch of version is reported immediately") {
  Scenario scenario = separated_robots(2);
  scenario.network.delay_min = scenario.network.delay_max = std::chrono::microseconds(100);
  Scene scene(scenario);
  scene.run(milliseconds(50));
  const Time start = scene.network.now() + std::chrono::microseconds(10'300);
  const Vec2 mark = scenario.robots[1].start_m;
  scene.send(1, test::command_with({1, 9, 1, 0, Trajectory::resting(start, mark)}));
  scene.run(milliseconds(100));
  const auto& robot_reports = scene.robot_reports[1];
  const auto first = std::find_if(robot_reports.begin(), robot_reports.end(),
                                  [](const msg::Feedback& f) { return f.executing().version_number() == 1; });
  REQUIRE(first != robot_reports.end());
  CHECK(first->valid_at_ns() == to_ns(start));
  CHECK(first->activated() == 1);
  CHECK(scene.node.world().firmware_violations() == 0);
}

TEST_CASE("every switch in a chain of pending versions is reported immediately") {
  Scenario scenario = separated_robots(1);
  scenario.network.delay_min = scenario.network.delay_max = std::chrono::microseconds(100);
  Scene scene(scenario);
  scene.run(milliseconds(50));
  const Vec2 mark = scenario.robots[0].start_m;
  std::vector<Time> starts;
  for (VersionNumber n = 1; n <= 4; ++n) {
    starts.push_back(scene.network.now() + std::chrono::microseconds(10'300 + 7'700 * n));
    scene.send(0, test::command_with({0, 9, n, n - 1, Trajectory::resting(starts.back(), mark)}));
  }
  scene.run(milliseconds(100));
  for (VersionNumber n = 1; n <= 4; ++n) {
    const auto& robot_reports = scene.robot_reports[0];
    const auto first = std::find_if(robot_reports.begin(), robot_reports.end(), [n](const msg::Feedback& f) {
      return f.executing().version_number() == n;
    });
    REQUIRE(first != robot_reports.end());
    CHECK(first->valid_at_ns() == to_ns(starts[n - 1]));
  }
}

TEST_CASE("a fence is acknowledged immediately") {
  Scenario scenario = separated_robots(1);
  scenario.network.delay_min = scenario.network.delay_max = std::chrono::microseconds(100);
  Scene scene(scenario);
  scene.run(milliseconds(50));
  const Time sent = scene.network.now();
  scene.send(0, test::bare_command(0, 1234));
  scene.run(std::chrono::microseconds(250));
  CHECK(scene.robot_reports[0].back().obeyed_incarnation() == 1234);
  CHECK(scene.robot_reports[0].back().valid_at_ns() == to_ns(sent + std::chrono::microseconds(100)));
}

TEST_CASE("a robot decides by its own clock on arrival whether a command is late") {
  Scenario scenario = separated_robots(1);
  scenario.network.delay_min = scenario.network.delay_max = milliseconds(10);
  Scene scene(scenario);
  scene.run(milliseconds(50));
  const Vec2 mark = scenario.robots[0].start_m;
  const Time now = scene.network.now();
  scene.send(0, test::command_with({0, 9, 1, 0, Trajectory::resting(now + milliseconds(10), mark)}));
  scene.run(milliseconds(50));
  CHECK(scene.node.world().firmware(0).counts().refused_late == 1);
  CHECK(scene.robot_reports[0].back().executing().version_number() == 0);
}

TEST_CASE("a simulator that is asked to end accepts no more versions and ends when all are shown at rest") {
  Scene scene(separated_robots(2));
  scene.run(milliseconds(50));
  const auto drive = [&](VersionNumber number, VersionNumber base, const State& from, Time start) {
    Trajectory trajectory(start, from);
    trajectory.append(milliseconds(300), Vec2(2, 0));
    append_stop(trajectory, 4);
    return Version{1, 9, number, base, trajectory};
  };
  const Version first =
      drive(1, 0, {scenario_start(scene, 1), Vec2(0, 0)}, scene.network.now() + milliseconds(50));
  scene.send(1, test::command_with(first));
  scene.run(milliseconds(20));
  CHECK(scene.node.moving_robots() == std::vector<RobotId>{1});
  CHECK_FALSE(scene.node.come_to_rest());
  const Time next = first.trajectory.start() + milliseconds(200);
  scene.send(1, test::command_with(drive(2, 1, first.trajectory.state_at(next), next)));
  while (!scene.node.come_to_rest()) {
    REQUIRE(scene.network.now() < first.trajectory.end() + milliseconds(500));
    scene.run(milliseconds(1));
  }
  const msg::TrueRobotState& shown = scene.truths.back().robots().at(1);
  CHECK(std::hypot(shown.vx_mps(), shown.vy_mps()) < 0.02);
  CHECK(scene.frames.back().captured_at_ns() > to_ns(first.trajectory.end()));
  CHECK(scene.network.now() >= first.trajectory.end());
  CHECK(scene.node.moving_robots().empty());
  CHECK(scene.node.world().firmware(1).executing().number == 1);
  CHECK(scene.node.world().bodies()[1].velocity_mps().norm() < 0.02);
}

TEST_CASE("frames are published exactly the scenario's delay after their capture") {
  Scenario scenario = separated_robots(3);
  scenario.vision.delay = milliseconds(35);
  Scene scene(scenario);
  scene.run(std::chrono::seconds(1));
  CHECK(scene.frames.size() >= 2 * 56);
  CHECK(scene.frames.size() <= 2 * 60);
  for (const auto& frame : scene.frames) {
    CHECK(frame.header().stamp_ns() - frame.captured_at_ns() == 35'000'000);
    CHECK(frame.header().sender() == static_cast<std::uint32_t>(Sender::kSimulator));
  }
}

TEST_CASE("ground truth is published 60 times per second") {
  Scene scene(separated_robots(3));
  scene.run(std::chrono::seconds(2));
  CHECK(scene.truths.size() >= 100);
  CHECK(scene.truths.size() <= 121);
  CHECK(scene.truths.back().robots().size() == 3);
  CHECK(to_ns(scene.network.now()) - scene.truths.back().valid_at_ns() < 25'000'000);
}

TEST_CASE("the radio loses commands at the scenario's rate") {
  Scenario scenario = separated_robots(1);
  scenario.command_loss = 0.3;
  Scene scene(scenario);
  for (int i = 0; i < 5000; ++i) {
    scene.send(0, test::bare_command(0, 0));  // malformed, so that the firmware counts the command
    scene.run(milliseconds(1));
  }
  const auto received = static_cast<double>(scene.node.world().firmware(0).counts().refused_malformed);
  CHECK(1 - received / 5000 == Approx(0.3).epsilon(0.1));
  CHECK(drops_of(scene.node).total(DropReason::kCommandLost) == 5000 - static_cast<std::uint64_t>(received));
  CHECK(drops_of(scene.node).total(DropReason::kMalformedCommand) == static_cast<std::uint64_t>(received));
}

TEST_CASE("the same seed gives the same messages") {
  const auto sum = [](std::uint64_t seed) {
    Scenario scenario = separated_robots(3);
    scenario.vision.miss_probability = 0.1;
    scenario.network.loss = 0.1;
    Scene scene(scenario, seed);
    scene.run(std::chrono::seconds(1));
    double total = 0;
    for (const auto& frame : scene.frames) {
      for (const auto& robot : frame.robots()) total += robot.x_m() + robot.heading_rad();
    }
    for (const auto& [robot, robot_reports] : scene.robot_reports) {
      for (const auto& robot_report : robot_reports)
        total += robot_report.x_m() + 1e-12 * static_cast<double>(robot_report.valid_at_ns() - to_ns(kBegin));
    }
    return total;
  };
  CHECK(sum(1) == sum(1));
  CHECK(sum(1) != sum(2));
}

// An agent that drives randomly over a bad network. Each version continues the one that the robot last
// reported as executed.
struct RandomAgent {
  void act(Scene& scene, std::size_t robot, Rng& rng) {
    const auto& robot_reports = scene.robot_reports[scene.scenario.robots[robot].id];
    if (robot_reports.empty()) return;
    const auto base = decode(robot_reports.back().executing());
    REQUIRE(base.has_value());
    const Time start = scene.network.now() + from_seconds(rng.uniform(0.02, 0.12));
    if (start <= base->trajectory.start()) return;
    const State state = base->trajectory.state_at(start);
    Trajectory trajectory(start, state);
    const Duration cycle = scene.scenario.cycle;
    const Vec2 desired = rotated(Vec2(20, 0), rng.uniform(-3.14, 3.14));
    trajectory.append(cycle, limit_acceleration(desired, state.velocity_mps, scene.scenario.limits, cycle));
    append_stop(trajectory, scene.scenario.limits.deceleration_mps2);
    newest = std::max(newest, base->number) + 1;
    scene.send(robot, test::command_with({base->robot, 1, newest, base->number, trajectory}));
  }
  VersionNumber newest = 0;
};

TEST_CASE("over a bad network, robots break no rule and their bodies follow their versions") {
  const std::uint64_t seed = GENERATE(1, 2, 3, 4);
  CAPTURE(seed);
  Scenario scenario = separated_robots(5);
  scenario.network = {0.3, 0.2, milliseconds(0), milliseconds(60)};
  Scene scene(scenario, seed);
  Rng rng(seed);
  std::vector<RandomAgent> agents(5);
  for (int cycle = 0; cycle < 600; ++cycle) {
    scene.run(scenario.cycle);
    for (std::size_t i = 0; i < agents.size(); ++i) agents[i].act(scene, i, rng);
  }
  std::uint64_t activated = 0;
  for (std::size_t i = 0; i < 5; ++i) activated += scene.node.world().firmware(i).counts().activated;
  CHECK(activated > 300);
  CHECK(scene.node.world().firmware_violations() == 0);
  for (const auto& truth : scene.truths) {
    for (const auto& robot : truth.robots()) CHECK(robot.reference_error_m() < 0.005);
  }
}

TEST_CASE("hostile commands over the bus do not stop the simulator") {
  Scene scene(separated_robots(1));
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Incarnation incarnation = rng.bits() >> rng.below(64);
    msg::Command command = encode(test::bare_command(static_cast<RobotId>(rng.below(3)), incarnation));
    command.has_version(rng.chance(0.8));
    command.version().phase_count(static_cast<std::uint8_t>(rng.bits()));
    command.version().start_ns(static_cast<std::int64_t>(rng.bits()));
    command.version().version_number(rng.bits());
    command.version().x_m(rng.chance(0.5) ? std::numeric_limits<double>::infinity() : 1e300);
    command.has_fix(rng.chance(0.5));
    command.fix().captured_at_ns(static_cast<std::int64_t>(rng.bits()));
    command.fix().x_m(-1e300);
    command.desired_heading_rad(rng.chance(0.1) ? std::numeric_limits<double>::quiet_NaN() : 1e308);
    scene.send(0, command);
    scene.run(std::chrono::microseconds(300));
  }
  scene.run(milliseconds(100));
  const auto& last = scene.robot_reports[0].back();
  CHECK(scene.node.world().firmware(0).counts().refused_malformed > 1000);
  CHECK(last.executing().version_number() == 0);
  CHECK(last.tracking_error_m() < 0.002);
  CHECK(scene.node.world().firmware_violations() == 0);
}

TEST_CASE("a disturbance is reported immediately, and an invalid one changes nothing") {
  Scenario scenario = separated_robots(2);
  scenario.network.delay_min = scenario.network.delay_max = std::chrono::microseconds(100);
  Scene scene(scenario);
  Writer<msg::Disturbance> disturbances = scene.outside.advertise(topics::kDisturbance);
  scene.run(milliseconds(50));
  const auto send = [&](RobotId robot, msg::DisturbanceKind kind) {
    msg::Disturbance message;
    message.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    message.robot(robot);
    message.disturbance_kind(kind);
    message.grip(2);
    message.vx_mps(std::numeric_limits<double>::quiet_NaN());
    message.clock_offset_ns(5'000'000);
    disturbances.publish(message, scene.network.now());
    scene.run(std::chrono::microseconds(250));
  };
  send(7, msg::DisturbanceKind::DISTURBANCE_LIFT);
  send(0, msg::DisturbanceKind::DISTURBANCE_SLIP);
  send(0, msg::DisturbanceKind::DISTURBANCE_PUSH);
  send(0, static_cast<msg::DisturbanceKind>(99));
  send(0, msg::DisturbanceKind::DISTURBANCE_PLACE);  // the robot is on the floor
  CHECK(drops_of(scene.node).total(DropReason::kRefusedDisturbance) == 5);
  CHECK_FALSE(scene.robot_reports[0].back().is_lifted());
  send(0, msg::DisturbanceKind::DISTURBANCE_LIFT);
  CHECK(scene.robot_reports[0].back().is_lifted());
  CHECK(scene.robot_reports[0].back().valid_at_ns() ==
        to_ns(scene.network.now() - std::chrono::microseconds(150)));
  send(1, msg::DisturbanceKind::DISTURBANCE_REBOOT);
  scene.run(milliseconds(6));
  CHECK(scene.robot_reports[1].back().is_off_reference());
  CHECK(scene.robot_reports[1].back().executing().version_number() >=
        robot::RobotSide<double>::kOwnNumberGap);
  send(1, msg::DisturbanceKind::DISTURBANCE_CLOCK);
  scene.run(milliseconds(100));
  CHECK(scene.robot_reports[1].back().valid_at_ns() > to_ns(scene.network.now()) - 20'000'000 + 5'000'000);
  scene.run(milliseconds(20));
  CHECK(scene.truths.back().robots().size() == 1);
  CHECK(drops_of(scene.node).total(DropReason::kRefusedDisturbance) == 5);
  CHECK(scene.node.world().firmware_violations() == 0);
}

TEST_CASE("the robot's clock determines when a version starts") {
  Scenario scenario = separated_robots(1);
  scenario.network.delay_min = scenario.network.delay_max = std::chrono::microseconds(100);
  scenario.robots[0].clock_offset = GENERATE(milliseconds(-3), milliseconds(3));
  Scene scene(scenario);
  scene.run(milliseconds(50));
  const Time robot_now = scene.network.now() + scenario.robots[0].clock_offset;
  const Time start = robot_now + std::chrono::microseconds(10'300);
  scene.send(0, test::command_with({0, 9, 1, 0, Trajectory::resting(start, scenario.robots[0].start_m)}));
  scene.run(milliseconds(30));
  const auto& robot_reports = scene.robot_reports[0];
  const auto first = std::find_if(robot_reports.begin(), robot_reports.end(),
                                  [](const msg::Feedback& f) { return f.executing().version_number() == 1; });
  REQUIRE(first != robot_reports.end());
  CHECK(first->valid_at_ns() == to_ns(start));
  CHECK(first->header().stamp_ns() == to_ns(start - scenario.robots[0].clock_offset));
}

TEST_CASE("disturbances, contacts, and own stops with their reasons are reported") {
  Scenario scenario = separated_robots(2);
  scenario.robots[0].start_m = Vec2(0, 0);
  scenario.robots[1].start_m = Vec2(0.25, 0);
  Scene scene(scenario);
  const LogEvents events(scene.node);
  auto writer = scene.outside.advertise(topics::kDisturbance);
  msg::Disturbance push;
  push.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
  push.robot(0);
  push.disturbance_kind(msg::DisturbanceKind::DISTURBANCE_PUSH);
  push.vx_mps(2);
  writer.publish(push, scene.network.now());
  scene.run(milliseconds(500));
  CAPTURE(events.text());
  CHECK(events.count("disturbance of robot 0: push") == 1);
  CHECK(events.count("robot 0 makes its own stop: ") >= 1);
  CHECK(events.count("robots 0 and 1 touch") == 1);
  push.robot(99);
  writer.publish(push, scene.network.now());
  scene.run(milliseconds(50));
  CHECK(events.count("refused a disturbance of robot 99") == 1);
  for (const LogEvent& event : events.all()) CHECK(event.robot.has_value());
}

}  // namespace sidestep::simulator_node_test
