// SPDX-License-Identifier: Apache-2.0
// Tests when the node sends commands, registrations, measurements, proposals and order reports.
#include <algorithm>
#include <optional>
#include <vector>

#include "agents/agent/agent_node.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/motion/time_to_rest.hpp"
#include "common/protocol/obstacle_bounds.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"

namespace sidestep::agent_cycle_test {

using namespace std::chrono_literals;

constexpr RobotId kRobot = 3;
constexpr Incarnation kSelf = 1000;
constexpr Epoch kEpoch = 7;
const Time kBegin = time_from_ns(1'000'000'000'000);
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);
constexpr auto kVision = static_cast<std::uint32_t>(Sender::kVision);

Scenario one_robot() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 3, team: blue, start_m: [0, 0], goals_m: [[1, 0]]}\n",
      "one-robot.yaml");
}

msg::OrderMemory memory_of(const RememberedOrder& order, bool is_announcement) {
  msg::OrderMemory memory = encode({&order, 1}, true, is_announcement).front();
  memory.process(kCoordinator);
  memory.header().sender(kCoordinator);
  return memory;
}

/// An agent's node, and one process that acts as its robot at rest, as vision and as the coordinator. The
/// network delay is 0.1 ms. The coordinator grants nothing. By default the coordinator answers registrations
/// but not proposals. Answers that do not echo the request's time do not measure the clock.
struct Floor {
  Scenario scenario = one_robot();
  SimNetwork network{1, kBegin, scenario.network};
  SimBus agent_bus{network, {1, {}}}, other_bus{network, {2, {}}};
  Duration robot_clock;  ///< offset of the robot's clock
  bool echoes_request_time = true, denies = false, is_heard = true, is_robot_silent = false;
  std::optional<Trajectory> executing;  ///< nullopt: the robot rests
  std::vector<Time> commands, registrations, proposals, order_reports;
  std::optional<msg::Command> last_command;
  Time command_received_at{};  ///< by the robot's clock
  Writer<msg::Feedback> robot_report_writer = other_bus.advertise(topics::kFeedback, kRobot);
  Writer<msg::Verdict> verdicts = other_bus.advertise(topics::kVerdict, kRobot);
  Writer<msg::CoordinatorState> states = other_bus.advertise(topics::kCoordinator);
  Writer<msg::WorldState> worlds = other_bus.advertise(topics::kWorld);
  Writer<msg::ObstacleList> obstacles = other_bus.advertise(topics::kObstacles);
  Writer<msg::OrderMemory> memories = other_bus.advertise(topics::kOrderMemory);
  AgentNode node{agent_bus, scenario, kRobot, kSelf, std::make_shared<PlanningScratch>(scenario)};

  explicit Floor(Duration robot_is_ahead = 0ms) : robot_clock(robot_is_ahead) {
    LinkQuality link;
    link.delay_min = link.delay_mean = link.delay_max = 100us;
    network.set_link(1, 2, link);
    network.set_link(2, 1, link);
    other_bus.subscribe(topics::kCommand, kRobot, [this](const msg::Command& command) {
      commands.push_back(time_from_ns(command.header().stamp_ns()));
      last_command = command;
      command_received_at = robot_now();
    });
    other_bus.subscribe(topics::kRegistration, [this](const msg::Registration& registration) {
      registrations.push_back(network.now());
      answer(echoes_request_time ? registration.header().stamp_ns() : 0, 0, msg::Reason::REASON_GRANTED);
    });
    other_bus.subscribe(topics::kProposal, [this](const msg::Proposal& proposal) {
      proposals.push_back(network.now());
      if (denies) answer(0, proposal.candidates().front().version_number(), msg::Reason::REASON_CONFLICT);
    });
    other_bus.subscribe(topics::kOrderStatus,
                        [this](const msg::OrderStatus&) { order_reports.push_back(network.now()); });
    network.run_until(network.now() + 10ms);  // the processes discover each other
    tell({{msg::OrderKind::ORDER_GO, kRobot, static_cast<ClientId>(Sender::kScenario), 1}}, false);
  }
  Time robot_now() const { return network.now() + robot_clock; }
  void tell(const RememberedOrder& order, bool is_announcement) {
    msg::OrderMemory memory = memory_of(order, is_announcement);
    memories.publish(memory, network.now());
  }
  void answer(std::int64_t request_stamp_ns, std::uint64_t proposal, msg::Reason reason) {
    msg::Verdict verdict;
    verdict.robot(kRobot);
    verdict.header().sender(kCoordinator);
    verdict.epoch(kEpoch);
    verdict.proposal_number(proposal);
    verdict.request_stamp_ns(request_stamp_ns);
    verdict.reasons().fill(reason);
    verdicts.publish(verdict, network.now());
  }
  void send_robot_report() {
    if (is_robot_silent) return;
    RobotReport robot_report;
    robot_report.robot = kRobot;
    robot_report.robot_incarnation = 5;
    robot_report.obeyed_incarnation = kSelf;
    robot_report.valid_at = robot_now();
    robot_report.executing = {kRobot, 0, 0, 0, Trajectory::resting(kBegin + robot_clock, {0, 0})};
    if (executing) robot_report.executing = {kRobot, kSelf, 9, 0, *executing};
    if (last_command) {
      robot_report.obeyed_epoch = last_command->epoch();
      robot_report.command = {{time_from_ns(last_command->header().stamp_ns()), command_received_at}};
    }
    auto message = encode(robot_report);
    robot_report_writer.publish(message, network.now());
  }
  void send_heartbeat() {
    msg::CoordinatorState state;
    state.header().sender(kCoordinator);
    state.epoch(kEpoch);
    state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
    state.watched_until_ns(to_ns(robot_now()));
    states.publish(state, network.now());
  }
  void send_vision_messages() {
    msg::WorldState world;
    world.header().sender(kVision);
    world.valid_at_ns(to_ns(robot_now()));
    world.robots().emplace_back().robot(kRobot);
    world.robots()[0].observed_at_ns(to_ns(robot_now()));
    worlds.publish(world, network.now());
    msg::ObstacleList list;
    list.header().sender(kVision);
    list.valid_at_ns(to_ns(robot_now()));
    list.complete_within_m(kCompleteEverywhere_m);
    obstacles.publish(list, network.now());
  }
  void run(Duration duration) {
    for (const Time end = network.now() + duration; network.now() < end;) {
      send_robot_report();
      send_vision_messages();
      if (is_heard) send_heartbeat();
      network.run_until(network.now() + 10ms);
    }
  }
  Duration cycle() const { return scenario.cycle; }
};

/// The intervals between successive times.
std::vector<Duration> gaps(const std::vector<Time>& times) {
  std::vector<Duration> result;
  for (std::size_t i = 1; i < times.size(); ++i) result.push_back(times[i] - times[i - 1]);
  return result;
}

TEST_CASE("cycles begin at multiples of the cycle time by the robot's clock") {
  const Duration ahead = GENERATE(0ms, 5ms, -5ms, 7203ms, -7203ms);
  CAPTURE(to_seconds(ahead));
  Floor floor(ahead);
  floor.run(1s);
  floor.commands.clear();
  floor.run(1s);
  REQUIRE(floor.commands.size() >= 55);
  for (const Time at : floor.commands) {
    const Duration phase = (at + ahead).time_since_epoch() % floor.cycle();
    CHECK(std::min(phase, floor.cycle() - phase) < 500us);
  }
  for (const Duration gap : gaps(floor.commands)) CHECK(std::chrono::abs(gap - floor.cycle()) < 1ms);
}

TEST_CASE("an agent registers every three cycles until it has measured the coordinator's clock") {
  Floor floor;
  floor.echoes_request_time = false;
  floor.denies = true;
  floor.run(1s);
  floor.registrations.clear();
  floor.run(1s);
  CHECK(floor.registrations.size() >= 19);
  for (const Duration gap : gaps(floor.registrations)) CHECK(std::chrono::abs(gap - 3 * floor.cycle()) < 1ms);
  CHECK(floor.proposals.empty());
  floor.echoes_request_time = true;
  floor.run(1s);
  CHECK_FALSE(floor.proposals.empty());
  floor.registrations.clear();
  floor.run(4s);
  // A measurement is valid for two seconds and is repeated after one second.
  CHECK(floor.registrations.size() >= 3);
  CHECK(floor.registrations.size() <= 5);
}

TEST_CASE("an agent whose robot may drive again proposes immediately unless the next cycle begins soon") {
  // Phase of the cycle in which the coordinator's heartbeat arrives.
  const double phase = GENERATE(0.1, 0.4, 0.6, 0.7, 0.8, 0.9);
  CAPTURE(phase);
  Floor floor;
  floor.run(1s);
  floor.is_heard = false;
  floor.run(1s);
  floor.proposals.clear();
  floor.run(500ms);
  REQUIRE(floor.proposals.empty());
  const Duration since_cycle = floor.network.now().time_since_epoch() % floor.cycle();
  floor.send_robot_report();
  floor.send_vision_messages();
  floor.network.run_until(floor.network.now() - since_cycle + floor.cycle() +
                          from_seconds(phase * to_seconds(floor.cycle())));
  const Time heard_at = floor.network.now();
  floor.send_heartbeat();
  floor.network.run_until(heard_at + 1ms);
  CHECK(floor.proposals.size() == (phase < 0.75 ? 1 : 0));
  floor.network.run_until(heard_at + floor.cycle());
  CHECK(floor.proposals.size() == 1);
}

TEST_CASE(
    "an agent that is asked to end proposes nothing more, and keeps its robot and coordinator informed") {
  Floor floor;
  floor.denies = true;
  floor.run(1s);
  REQUIRE_FALSE(floor.proposals.empty());
  (void)floor.node.come_to_rest();
  floor.run(100ms);
  floor.proposals.clear();
  floor.commands.clear();
  floor.registrations.clear();
  floor.run(3s);
  CHECK(floor.proposals.empty());
  CHECK(floor.commands.size() >= 170);
  CHECK(floor.node.come_to_rest());
}

TEST_CASE("an agent that is asked to end does not end while its robot executes a version that moves it") {
  Floor floor;
  floor.run(1s);
  const bool is_known = GENERATE(true, false);
  CAPTURE(is_known);
  // The robot reports a version that lasts long, or falls silent after it has.
  floor.executing = Trajectory(floor.robot_now(), State{Vec2(0, 0), Vec2(1, 0)});
  floor.executing->append(50s, Vec2(0, 0));
  floor.run(100ms);
  floor.is_robot_silent = !is_known;
  CHECK_FALSE(floor.node.is_at_rest());
  Duration waited{0};
  for (; !floor.node.come_to_rest(); waited += 100ms) {
    REQUIRE(waited < 10s);
    floor.run(100ms);
  }
  // It gives up after twice the time in which a robot comes to rest.
  CHECK(waited >= 2 * time_to_rest(floor.scenario.limits) - 100ms);
  CHECK_FALSE(floor.node.is_at_rest());
}

TEST_CASE("an agent confirms each announced hold of its robot, even if the announcement is a repetition") {
  Floor floor;
  constexpr ClientId kClient = 1'000'001;
  const auto announce = [&](msg::OrderKind kind, RobotId robot) {
    floor.run(250ms);
    const std::size_t before = floor.order_reports.size();
    floor.tell({{kind, robot, kClient, 5}}, true);
    floor.network.run_until(floor.network.now() + 1ms);
    return floor.order_reports.size() - before;
  };
  floor.run(1s);
  for (const RobotId robot : {kRobot, kAllRobots}) {
    CAPTURE(robot);
    CHECK(announce(msg::OrderKind::ORDER_HOLD, robot) == 1);
    CHECK(announce(msg::OrderKind::ORDER_HOLD, robot) == 1);
  }
  CHECK(announce(msg::OrderKind::ORDER_HOLD, kRobot + 1) == 0);
  CHECK(announce(msg::OrderKind::ORDER_CANCEL, kRobot + 1) == 0);
}

TEST_CASE("an agent reports its order once per second, and immediately when the order changes") {
  Floor floor;
  floor.run(1s);
  floor.order_reports.clear();
  floor.run(5s);
  CHECK(floor.order_reports.size() == 5);
  for (const Duration gap : gaps(floor.order_reports)) CHECK(std::chrono::abs(gap - 1s) < 15ms);
}

}  // namespace sidestep::agent_cycle_test
