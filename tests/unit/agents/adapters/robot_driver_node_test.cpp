// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/robot_driver_node.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/motion/robot_model.hpp"
#include "common/protocol/report_period.hpp"
#include "tests/catch.hpp"
#include "tests/log_events.hpp"

namespace sidestep::robot_driver_node_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);

/// Bases that do not move.
class IdleDriver : public Driver {
 public:
  void send(std::span<const BaseCommand> commands) override {
    periods += commands.size() == 2;
    max_speed_mps = 0;
    for (const BaseCommand& command : commands)
      max_speed_mps = std::max(max_speed_mps, command.velocity.linear_mps.norm());
  }
  void on_odometry(std::function<void(const OdometryReport&)> callback) override {
    report = std::move(callback);
  }
  int periods = 0;
  double max_speed_mps = 0;  ///< largest speed among the latest commands
  std::function<void(const OdometryReport&)> report;
};

/// Two robots at rest, and their agents.
struct Scene {
  explicit Scene(Duration cycle = Scenario{}.cycle) {
    scenario.cycle = cycle;
    for (const RobotId id : {4u, 7u}) {
      RobotSpec robot;
      robot.id = id;
      scenario.robots.push_back(robot);
      writers.push_back(agent_bus.advertise(topics::kCommand, id));
      agent_bus.subscribe<msg::Feedback>(topics::kFeedback, id, [this](const msg::Feedback& robot_report) {
        robot_reports.push_back(robot_report);
      });
    }
    node.emplace(*robot_bus, scenario, roster_of(scenario), 55, DriveSettings{}, driver, memory.path());
  }
  void command(std::size_t index, Incarnation incarnation, Epoch epoch,
               const std::optional<Version>& version = std::nullopt) {
    Command command;
    command.robot = scenario.robots[index].id;
    command.incarnation = incarnation;
    command.epoch = epoch;
    if (!version) command.fix = PoseFix{agent_bus.now() - 20ms, Vec2(static_cast<double>(index), 0), 0};
    command.version = version;
    auto message = encode(command);
    writers[index].publish(message, agent_bus.now());
  }
  void run(Duration duration) { network.run_until(network.now() + duration); }

  Scenario scenario;
  TemporaryFolder memory;
  SimNetwork network{1, kBegin, {}};
  SimBus agent_bus{network};
  std::optional<SimBus> robot_bus{std::in_place, network};
  IdleDriver driver;
  std::optional<RobotDriverNode> node;
  std::vector<Writer<msg::Command>> writers;
  std::vector<msg::Feedback> robot_reports;
};

}  // namespace

TEST_CASE("driven robots report about once per cycle, and immediately when they obey a new agent") {
  Scene scene;
  for (int i = 0; i < 60; ++i) {
    scene.command(0, 100, 1);
    scene.run(20ms);
  }
  REQUIRE_FALSE(scene.robot_reports.empty());
  CHECK(scene.robot_reports.front().robot() == 4);
  CHECK(scene.robot_reports.front().header().incarnation() == 55);
  scene.robot_reports.clear();
  scene.run(1s);
  CHECK(scene.robot_reports.size() >= 49);
  scene.robot_reports.clear();
  const Time sent = scene.network.now();
  scene.command(0, 200, 2);
  scene.run(3ms);
  REQUIRE_FALSE(scene.robot_reports.empty());
  CHECK(scene.robot_reports.front().obeyed_incarnation() == 200);
  CHECK(time_from_ns(scene.robot_reports.front().header().stamp_ns()) - sent < 2ms);
  CHECK(scene.node->is_commanded());
  CHECK(scene.driver.periods > 100);
}

TEST_CASE("the reports of driven robots are at most as far apart as robots may report, at any control rate") {
  const int rate_hz = GENERATE(5, 30, 60, 100, 500);
  CAPTURE(rate_hz);
  Scene scene(from_seconds(1.0 / rate_hz));
  for (int i = 0; i < 60; ++i) {
    scene.command(0, 100, 1);
    scene.run(20ms);
  }
  scene.robot_reports.clear();
  scene.run(3s);
  REQUIRE(scene.robot_reports.size() > 10);
  for (std::size_t i = 1; i < scene.robot_reports.size(); ++i)
    CHECK(Duration{scene.robot_reports[i].valid_at_ns() - scene.robot_reports[i - 1].valid_at_ns()} <=
          max_report_gap(scene.scenario.cycle));
}

TEST_CASE("odometry with a wrong timestamp is counted for its robot") {
  Scene scene;
  scene.run(100ms);
  const Time now = scene.network.now();
  scene.driver.report({4, now, {0, 0}, 0});
  scene.driver.report({7, now + 100ms, {0, 0}, 0});
  scene.driver.report({7, now - 100ms, {0, 0}, 0});
  scene.driver.report({99, now + 100ms, {0, 0}, 0});
  CHECK(scene.node->robot(0).misdated_odometry() == 0);
  CHECK(scene.node->robot(1).misdated_odometry() == 2);
  DropCounters drops;
  scene.node->count_drops(drops);
  CHECK(drops.total(DropReason::kMisdatedOdometry) == 2);
}

TEST_CASE("when their process must end, robots finish their versions and accept no new versions") {
  Scene scene;
  for (int i = 0; i < 60; ++i) {
    scene.command(0, 100, 1);
    scene.run(20ms);
  }
  REQUIRE_FALSE(scene.robot_reports.empty());
  CHECK(scene.node->moving_robots().empty());
  CHECK_FALSE(scene.node->come_to_rest());
  scene.run(DriveSettings{}.latency + 300ms);
  CHECK(scene.node->come_to_rest());

  Scene driving;
  for (int i = 0; i < 60; ++i) {
    driving.command(0, 100, 1);
    driving.run(20ms);
  }
  const auto version_of = [&](const Version& base, Time start) {
    Trajectory trajectory(start, base.trajectory.state_at(start));
    trajectory.append(500ms, Vec2(1, 0));
    append_stop(trajectory, 1);
    return Version{base.robot, 100, base.number + 1, base.number, trajectory};
  };
  const auto robot_report =
      decode(driving.robot_reports.back(), driving.scenario.robots[0].id, driving.network.now());
  REQUIRE(robot_report);
  const Version first = version_of(robot_report->executing, driving.network.now() + 150ms);
  const Version second = version_of(first, first.trajectory.start() + 700ms);
  driving.command(0, 100, 1, first);
  driving.run(400ms);
  REQUIRE(driving.driver.max_speed_mps > 0.1);
  CHECK_FALSE(driving.node->come_to_rest());
  driving.command(0, 100, 1, second);
  // The base obeys after its latency.
  while (driving.network.now() < first.trajectory.end() + DriveSettings{}.latency) {
    CHECK_FALSE(driving.node->come_to_rest());
    CHECK(driving.node->moving_robots() == std::vector<RobotId>{4});
    driving.run(10ms);
  }
  // The last commands are those to stand still: some bases keep the last velocity for a while.
  Duration standstill{0};
  for (; !driving.node->come_to_rest(); standstill += 10ms) {
    REQUIRE(standstill < 1s);
    driving.run(10ms);
    CHECK(driving.driver.max_speed_mps == 0);
  }
  CHECK(standstill >= DriveSettings{}.latency + 300ms);
  CHECK(driving.node->robot(0).side().executing().number == first.number);
}

TEST_CASE("when their process must end, bases that fixes show in motion are commanded to rest for longer") {
  const bool stops = GENERATE(true, false);
  CAPTURE(stops);
  Scene scene;
  for (int i = 0; i < 60; ++i) {
    scene.command(0, 100, 1);
    scene.run(20ms);
  }
  // The base slides at 0.5 m/s, for a second or for ever.
  Duration lasted{0};
  const auto send_fix = [&] {
    const double slid_s = to_seconds(stops ? std::min<Duration>(lasted, 1s) : lasted);
    Command command;
    command.robot = 4;
    command.incarnation = 100;
    command.epoch = 1;
    command.fix = PoseFix{scene.agent_bus.now() - 20ms, Vec2(0.5 * slid_s, 0), 0};
    auto message = encode(command);
    scene.writers[0].publish(message, scene.agent_bus.now());
  };
  bool has_moved = false;
  for (; !scene.node->come_to_rest(); lasted += 20ms) {
    REQUIRE(lasted < 10s);
    send_fix();
    scene.run(20ms);
    has_moved |= scene.node->moving_robots() == std::vector<RobotId>{4};
  }
  CHECK(has_moved);
  CHECK(lasted >= (stops ? 1100ms : 2100ms));
  CHECK(lasted <= (stops ? 2000ms : 4000ms));
}

TEST_CASE("restarted robots remember the agent that they obey, and count commands that cannot be stored") {
  Scene scene;
  for (int i = 0; i < 60; ++i) {
    scene.command(1, 100, 9);
    scene.run(20ms);
  }
  scene.robot_bus.reset();  // destroyed first, because the bus calls the node
  scene.node.reset();
  SimBus second_bus(scene.network);
  RobotDriverNode second(second_bus, scene.scenario, roster_of(scene.scenario), 56, DriveSettings{},
                         scene.driver, scene.memory.path());
  CHECK(second.robot(1).side().obeyed_incarnation() == 100);
  CHECK(second.robot(1).side().obeyed_epoch() == 9);
  const LogEvents events(second);
  std::filesystem::remove_all(scene.memory.path());
  scene.command(1, 300, 10);
  scene.run(5ms);
  CHECK(second.robot(1).side().obeyed_incarnation() == 100);
  DropCounters drops;
  second.count_drops(drops);
  CHECK(drops.total(DropReason::kUnstoredCommand) == 1);
  scene.run(100ms);
  INFO(events.text());
  CHECK(events.count("robot 7 refuses commands because it cannot store its state: cannot write " +
                     scene.memory.file("robot-7.memory") + ": the folder " + scene.memory.path() +
                     " does not exist") == 1);
  std::filesystem::create_directories(scene.memory.path());
  scene.command(1, 300, 10);
  scene.run(100ms);
  CHECK(second.robot(1).side().obeyed_incarnation() == 300);
  CHECK(events.count("robot 7 can store its state again") == 1);
}

}  // namespace sidestep::robot_driver_node_test
