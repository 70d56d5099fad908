// SPDX-License-Identifier: Apache-2.0
// Tests that hostile messages to the node do not reach the agent and are each counted once.
#include "agents/agent/agent_node.hpp"

#include <limits>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/course_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/protocol/senders.hpp"
#include "idl/disturbance.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::agent_node_test {

constexpr RobotId kRobot = 3;
constexpr Incarnation kSelf = 1000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Time kBegin = time_from_ns(1'000'000'000'000);
constexpr std::uint64_t kHuge = std::uint64_t{1} << 61;  ///< an implausible number or time in nanoseconds
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);

Scenario one_robot() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 3, team: blue, start_m: [0, 0], goals_m: [[1, 0]]}\n",
      "one-robot.yaml");
}

/// The report of a robot at rest that obeys the agent.
msg::Feedback valid_robot_report() {
  RobotReport robot_report;
  robot_report.robot = kRobot;
  robot_report.robot_incarnation = 5;
  robot_report.obeyed_incarnation = kSelf;
  robot_report.valid_at = kBegin;
  robot_report.executing = {kRobot, 0, 0, 0, Trajectory::resting(kBegin, {0, 0})};
  return encode(robot_report);
}

msg::CoordinatorState valid_coordinator_state() {
  msg::CoordinatorState state;
  state.header().sender(kCoordinator);
  state.epoch(7);
  state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  return state;
}

msg::WorldState valid_world() {
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  world.robots().emplace_back().robot(kRobot);
  world.robots()[0].observed_at_ns(to_ns(kBegin));
  return world;
}

msg::ObstacleList valid_obstacles() {
  msg::ObstacleList list;
  list.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  list.valid_at_ns(to_ns(kBegin));
  list.obstacles().emplace_back().observed_at_ns(to_ns(kBegin));
  return list;
}

/// A page with one version near the robot.
msg::LedgerPage valid_page() {
  msg::LedgerPage page;
  page.header().sender(kCoordinator);
  page.epoch(1);
  page.versions().push_back(encode(Version{4, 1, 1, 0, Trajectory::resting(kBegin, {0, 0})}));
  return page;
}

msg::Disturbance placement(RobotId robot, double x) {
  msg::Disturbance disturbance;
  disturbance.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
  disturbance.robot(robot);
  disturbance.disturbance_kind(msg::DisturbanceKind::DISTURBANCE_PLACE);
  disturbance.x_m(x);
  return disturbance;
}

/// An agent's node on a bus, and another process that sends it messages and reads its status.
struct NodeFixture {
  Scenario scenario = one_robot();
  SimNetwork network{1, kBegin, scenario.network};
  SimBus agent_bus{network}, other_bus{network};
  Writer<msg::OrderMemory> memory_writer;
  msg::AgentStatus status;
  std::uint64_t commands = 0;
  Epoch commanded_epoch = 0;  ///< epoch of the last command
  AgentNode node{agent_bus, scenario, kRobot, kSelf, std::make_shared<PlanningScratch>(scenario)};

  NodeFixture() {
    const RememberedOrder order{
        {msg::OrderKind::ORDER_GO, kRobot, static_cast<ClientId>(Sender::kScenario), 1}};
    msg::OrderMemory memory = encode({&order, 1}, true, false).front();
    memory.process(kCoordinator);
    memory.header().sender(kCoordinator);
    memory_writer = other_bus.advertise(topics::kOrderMemory);
    memory_writer.publish(memory, other_bus.now());
    other_bus.subscribe(topics::kStatus, [this](const msg::AgentStatus& latest) { status = latest; });
    other_bus.subscribe(topics::kCommand, kRobot, [this](const msg::Command& command) {
      ++commands;
      commanded_epoch = command.epoch();
    });
  }
  /// Runs until another status has arrived.
  void run() { network.run_until(network.now() + Duration{250'000'000}); }
  /// The number of messages that the node and its bus have dropped.
  std::uint64_t dropped() const { return drops_of(node).total() + drops_of(agent_bus).total(); }
  /// Sends one message. Returns the increase in the number of dropped messages.
  template <typename Message>
  std::uint64_t send(const Topic<Message>& topic, Message message) {
    auto writer = other_bus.advertise(topic, kRobot);
    run();  // the agent discovers the writer
    const std::uint64_t before = dropped();
    writer.publish(message, other_bus.now());
    run();
    return dropped() - before;
  }
  template <typename Message, typename Spoil>
  std::uint64_t send_invalidated(const Topic<Message>& topic, Message message, Spoil spoil) {
    spoil(message);
    return send(topic, message);
  }
};

TEST_CASE("valid messages are not counted as invalid") {
  NodeFixture f;
  CHECK(f.send(topics::kFeedback, valid_robot_report()) == 0);
  CHECK(f.send(topics::kCoordinator, valid_coordinator_state()) == 0);
  msg::CoordinatorState standby;
  standby.header().sender(kCoordinator);
  CHECK(f.send(topics::kCoordinator, standby) == 0);
  msg::Verdict verdict;
  verdict.robot(kRobot);
  verdict.header().sender(kCoordinator);
  verdict.epoch(7);
  CHECK(f.send(topics::kVerdict, verdict) == 0);
  CHECK(f.send(topics::kWorld, valid_world()) == 0);
  msg::WorldState empty;
  empty.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  CHECK(f.send(topics::kWorld, empty) == 0);
  CHECK(f.send(topics::kObstacles, valid_obstacles()) == 0);
  CHECK(f.send(topics::kLedger, valid_page()) == 0);
  CHECK(f.send(topics::kDisturbance, placement(kRobot, 1)) == 0);
  CHECK(f.commands > 0);
  CHECK(f.status.header().sender() == kRobot);
  CHECK(f.status.header().incarnation() == kSelf);
}

TEST_CASE("invalid feedback is counted and changes nothing") {
  NodeFixture f;
  const auto send = [&](auto spoil) {
    return f.send_invalidated(topics::kFeedback, valid_robot_report(), spoil);
  };
  CHECK(send([](msg::Feedback& m) { m.executing().x_m(kNan); }) == 1);
  CHECK(send([](msg::Feedback& m) { m.executing().phase_count(99); }) == 1);
  CHECK(send([](msg::Feedback& m) { m.obeyed_epoch(kHuge); }) == 1);
  CHECK(send([](msg::Feedback& m) { m.obeyed_incarnation(kHuge); }) == 1);
  // Needs a new fixture, because the old one would refuse the message as coming from a second process.
  CHECK(NodeFixture().send_invalidated(topics::kFeedback, valid_robot_report(),
                                       [](msg::Feedback& m) { m.header().incarnation(kHuge); }) == 1);
  CHECK(send([](msg::Feedback& m) { m.valid_at_ns(static_cast<std::int64_t>(kHuge)); }) == 1);
  CHECK(send([](msg::Feedback& m) { m.vx_mps(kNan); }) == 1);
  CHECK(send([](msg::Feedback& m) { m.robot(kRobot + 1); }) == 1);
  CHECK(f.status.agent_state() == msg::AgentState::AGENT_FENCING);
  CHECK(f.send(topics::kFeedback, valid_robot_report()) == 0);
  CHECK(f.status.agent_state() == msg::AgentState::AGENT_WAITING);
  CHECK(f.status.distance_to_go_m() == 1);
  CHECK(send([](msg::Feedback& m) { m.position_error_rms_m(kNan), m.x_m(1); }) == 1);
  CHECK(f.status.distance_to_go_m() == 1);
}

TEST_CASE("invalid coordinator states are counted and change nothing") {
  NodeFixture f;
  const auto send = [&](auto spoil) {
    return f.send_invalidated(topics::kCoordinator, valid_coordinator_state(), spoil);
  };
  REQUIRE(f.send(topics::kFeedback, valid_robot_report()) == 0);
  CHECK(send([](msg::CoordinatorState& m) { m.epoch(kHuge); }) == 1);
  CHECK(send([](msg::CoordinatorState& m) { m.epoch(std::numeric_limits<Epoch>::max()); }) == 1);
  CHECK(send([](msg::CoordinatorState& m) { m.coordinator_mode(static_cast<msg::CoordinatorMode>(9)); }) ==
        1);
  CHECK(f.commanded_epoch == 0);
  CHECK(f.send(topics::kCoordinator, valid_coordinator_state()) == 0);
  CHECK(f.commanded_epoch == 7);
}

TEST_CASE("invalid verdicts are counted") {
  NodeFixture f;
  msg::Verdict verdict;
  verdict.robot(kRobot + 1);
  CHECK(f.send(topics::kVerdict, verdict) == 1);
  verdict.robot(kRobot);
  CHECK(f.send(topics::kVerdict, verdict) == 1);  // the sender is not a coordinator
  verdict.header().sender(kCoordinator);
  verdict.reasons()[4] = static_cast<msg::Reason>(99);
  CHECK(f.send(topics::kVerdict, verdict) == 1);
}

TEST_CASE("each invalid observation in a world state is counted") {
  NodeFixture f;
  const auto send = [&](auto spoil) { return f.send_invalidated(topics::kWorld, valid_world(), spoil); };
  CHECK(send([](msg::WorldState& m) { m.robots()[0].observed_x_m(kNan); }) == 1);
  CHECK(send([](msg::WorldState& m) { m.robots()[0].observed_at_ns(to_ns(kMaxTime)); }) == 1);
  CHECK(send([](msg::WorldState& m) { m.robots()[0].observed_heading_rad(kNan); }) == 1);
  CHECK(send([](msg::WorldState& m) { m.robots()[0].y_m(kNan); }) == 1);
}

TEST_CASE("each invalid list of obstacles is counted") {
  NodeFixture f;
  using List = msg::ObstacleList;
  const auto send = [&](auto spoil) {
    return f.send_invalidated(topics::kObstacles, valid_obstacles(), spoil);
  };
  CHECK(send([](List& m) { m.obstacles()[0].radius_m(-1); }) == 1);
  CHECK(send([](List& m) { m.obstacles()[0].x_m(kNan); }) == 1);
  CHECK(send([](List& m) { m.obstacles()[0].observed_at_ns(to_ns(kMaxTime)); }) == 1);
  CHECK(send([](List& m) { m.obstacles().resize(msg::MAX_OBSTACLES + 1); }) == 1);
  CHECK(send([](List& m) { m.complete_within_m(kNan); }) == 1);
  CHECK(send([](List& m) { m.valid_at_ns(to_ns(kMaxTime)); }) == 1);
  CHECK(send([](List& m) { m.header().sender(kRobot); }) == 1);
}

TEST_CASE("a world state that is not from vision counts as one invalid message") {
  NodeFixture f;
  CHECK(f.send_invalidated(topics::kWorld, valid_world(),
                           [](msg::WorldState& m) { m.header().sender(kRobot); }) == 1);
}

TEST_CASE("invalid ledger pages, and invalid versions on valid pages, are counted") {
  NodeFixture f;
  const auto send = [&](auto spoil) { return f.send_invalidated(topics::kLedger, valid_page(), spoil); };
  CHECK(send([](msg::LedgerPage& m) { m.page_index(kMaxRobots); }) == 1);
  CHECK(send([](msg::LedgerPage& m) { m.epoch(kHuge); }) == 1);
  CHECK(send([](msg::LedgerPage& m) { m.versions()[0].vx_mps(kNan); }) == 1);
}

DrivingCourse course_of(RobotId robot) {
  DrivingCourse course;
  course.robot = robot;
  course.planned_at = course.start = kBegin;
  course.states = {{{1, 0}, {0, 0}}};
  return course;
}

TEST_CASE("invalid courses and offers that a coordinator relays are counted, and all that agents send") {
  NodeFixture f;
  const auto send = [&](auto spoil) {
    msg::Course course = encode(course_of(kRobot + 1));
    course.header().sender(kCoordinator);
    return f.send_invalidated(topics::kSharedCourse, course, spoil);
  };
  CHECK(send([](msg::Course&) {}) == 0);
  CHECK(send([](msg::Course& m) { m.planned_at_ns(0); }) == 1);
  CHECK(send([](msg::Course& m) { m.points()[0].x_m(static_cast<float>(kNan)); }) == 1);
  CHECK(send([](msg::Course& m) { m.header().sender(kRobot + 1); }) == 1);
  const auto offer = [&](auto spoil) {
    msg::CourseOffer offered = encode(CourseOffer{course_of(kRobot), kBegin, kRobot + 1});
    offered.header().sender(kCoordinator);
    return f.send_invalidated(topics::kSharedCourseOffer, offered, spoil);
  };
  CHECK(offer([](msg::CourseOffer&) {}) == 0);
  CHECK(offer([](msg::CourseOffer& m) { m.points().clear(); }) == 1);
  CHECK(offer([](msg::CourseOffer& m) { m.by(kMaxRobots); }) == 1);
  CHECK(offer([](msg::CourseOffer& m) { m.header().sender(kRobot + 1); }) == 1);
}

TEST_CASE("an agent repeats announced orders immediately, but at most ten times per second") {
  NodeFixture f;
  std::vector<std::pair<Time, OrderNumber>> repeated;
  f.other_bus.subscribe(topics::kAgentOrders, [&](const msg::OrderMemory& message) {
    const auto page = decode(message, f.network.now());
    REQUIRE(page);
    CHECK(page->process == kRobot);
    for (const RememberedOrder& order : page->orders)
      repeated.emplace_back(f.network.now(), order.order.number);
  });
  f.run();
  const auto announce = [&](OrderNumber number) {
    const RememberedOrder order{{msg::OrderKind::ORDER_CANCEL, kRobot + 1, 1'000'001, number}};
    msg::OrderMemory memory = encode({&order, 1}, true, true).front();
    memory.process(kCoordinator);
    memory.header().sender(kCoordinator);
    f.memory_writer.publish(memory, f.other_bus.now());
  };
  const Time begin = f.network.now();
  OrderNumber number = 10;
  for (; f.network.now() < begin + Duration{2'000'000'000};
       f.network.run_until(f.network.now() + Duration{5'000'000}))
    announce(++number);
  f.run();
  REQUIRE(!repeated.empty());
  CHECK(repeated.front().second == 11);
  CHECK(repeated.front().first - begin < Duration{5'000'000});
  CHECK(repeated.back().second == number);
  CHECK(repeated.size() <= 22);
  CHECK(repeated.size() >= 15);
  // A coordinator that missed the first repetition announces the order again, and the agent must repeat it.
  const std::size_t before = repeated.size();
  announce(number);
  f.run();
  CHECK(repeated.size() == before + 1);
}

TEST_CASE("an invalid placement is counted only if it concerns the agent's own robot") {
  NodeFixture f;
  CHECK(f.send(topics::kDisturbance, placement(kRobot, kNan)) == 1);
  CHECK(f.send(topics::kDisturbance, placement(kRobot + 1, kNan)) == 0);
  msg::Disturbance push = placement(kRobot, kNan);
  push.disturbance_kind(msg::DisturbanceKind::DISTURBANCE_PUSH);
  CHECK(f.send(topics::kDisturbance, push) == 0);
  // Only an operator may report where a robot was put down.
  msg::Disturbance forged = placement(kRobot, 1);
  forged.header().sender(kRobot);
  CHECK(f.send(topics::kDisturbance, forged) == 1);
}

}  // namespace sidestep::agent_node_test
