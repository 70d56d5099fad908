// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/robots_node.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::robots_node_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);

/// Bases that stay where they are.
class IdleDriver : public Driver {
 public:
  void send(std::span<const BaseCommand> commands) override { periods += commands.size() == 2; }
  void on_odometry(std::function<void(const OdometryReport&)> callback) override {
    report = std::move(callback);
  }
  int periods = 0;
  std::function<void(const OdometryReport&)> report;
};

/// Two robots that stand, and their agents.
struct Scene {
  Scene() {
    for (const RobotId id : {4u, 7u}) {
      RobotSpec robot;
      robot.id = id;
      scenario.robots.push_back(robot);
      writers.push_back(agent_bus.advertise(topics::kCommand, id));
      agent_bus.subscribe<msg::Feedback>(topics::kFeedback, id,
                                         [this](const msg::Feedback& fact) { facts.push_back(fact); });
    }
    node.emplace(*robot_bus, scenario, roster_of(scenario), 55, DriveSettings{}, driver, memory.path());
  }
  void command(std::size_t index, Incarnation incarnation, Epoch epoch) {
    Command command;
    command.robot = scenario.robots[index].id;
    command.incarnation = incarnation;
    command.epoch = epoch;
    command.fix = PoseFix{agent_bus.now() - 20ms, Vec2(static_cast<double>(index), 0), 0};
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
  std::optional<RobotsNode> node;
  std::vector<Writer<msg::Command>> writers;
  std::vector<msg::Feedback> facts;
};

}  // namespace

TEST_CASE("driven robots report at least once per cycle, and at once when they obey a new agent") {
  Scene scene;
  for (int i = 0; i < 60; ++i) {
    scene.command(0, 100, 1);
    scene.run(20ms);
  }
  REQUIRE_FALSE(scene.facts.empty());
  CHECK(scene.facts.front().robot() == 4);
  CHECK(scene.facts.front().header().incarnation() == 55);
  scene.facts.clear();
  scene.run(1s);
  CHECK(scene.facts.size() >= 49);
  scene.facts.clear();
  const Time sent = scene.network.now();
  scene.command(0, 200, 2);
  scene.run(3ms);
  REQUIRE_FALSE(scene.facts.empty());
  CHECK(scene.facts.front().obeyed_incarnation() == 200);
  CHECK(time_from_ns(scene.facts.front().header().stamp_ns()) - sent < 2ms);
  CHECK(scene.node->is_commanded());
  CHECK(scene.driver.periods > 100);
}

TEST_CASE("odometry that is dated wrongly is counted for its robot") {
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

TEST_CASE("robots that restart remember whom they obey, and count what they cannot store") {
  Scene scene;
  for (int i = 0; i < 60; ++i) {
    scene.command(1, 100, 9);
    scene.run(20ms);
  }
  scene.robot_bus.reset();  // first, so that it calls nobody any more
  scene.node.reset();
  SimBus second_bus(scene.network);
  RobotsNode second(second_bus, scene.scenario, roster_of(scene.scenario), 56, DriveSettings{}, scene.driver,
                    scene.memory.path());
  CHECK(second.robot(1).side().obeyed_incarnation() == 100);
  CHECK(second.robot(1).side().obeyed_epoch() == 9);
  std::filesystem::remove_all(scene.memory.path());
  scene.command(1, 300, 10);
  scene.run(5ms);
  CHECK(second.robot(1).side().obeyed_incarnation() == 100);
  DropCounters drops;
  second.count_drops(drops);
  CHECK(drops.total(DropReason::kUnstoredCommand) == 1);
  std::filesystem::create_directories(scene.memory.path());
}

}  // namespace sidestep::robots_node_test
