// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator_node.hpp"

#include <limits>
#include <vector>

#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/log_events.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::coordinator_node_test {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Scenario two_robots() {
  Scenario scenario;
  scenario.field = {20, 20};
  for (const RobotId id : {1, 2}) {
    RobotSpec robot;
    robot.id = id;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

/// A world state in which vision observes these robots at the origin.
msg::WorldState world_of(std::initializer_list<RobotId> robots, Time at) {
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  world.valid_at_ns(to_ns(at));
  for (const RobotId id : robots) {
    msg::TrackedRobot& robot = world.robots().emplace_back();
    robot.robot(id);
    robot.observed_at_ns(to_ns(at));
  }
  return world;
}

// A coordinator and a second process that receives what it publishes.
struct Floor {
  explicit Floor(bool is_standby = false) : node(bus, scenario, {0, 5}, is_standby) {
    outside.subscribe(topics::kCoordinator,
                      [this](const msg::CoordinatorState& message) { state = message; });
    for (const RobotSpec& robot : scenario.robots) {
      outside.subscribe(topics::kVerdict, robot.id,
                        [this](const msg::Verdict& message) { verdicts.push_back(message); });
    }
    run();
  }

  /// Runs for longer than the heartbeat period.
  void run() { run_for(std::chrono::milliseconds(30)); }
  void run_for(Duration duration) { network.run_until(network.now() + duration); }
  template <typename Message>
  void send(const Topic<Message>& topic, Message message, RobotId channel = 1) {
    auto writer = outside.advertise(topic, channel);
    if (topic.qos == Qos::kEvent) run_for(std::chrono::milliseconds(200));  // the node discovers the writer
    writer.publish(message, network.now());
    run();
  }
  void register_both() {
    send(topics::kRegistration, registration_of(a, node.coordinator().epoch()));
    send(topics::kRegistration, registration_of(b, node.coordinator().epoch()));
    REQUIRE(node.coordinator().is_granting());
    verdicts.clear();
  }
  msg::Proposal proposal() const {
    return proposal_of({continued(a, 10, 1001, {0, 3})}, node.coordinator().epoch());
  }

  const Scenario scenario = two_robots();
  const Version a = rest_version(1, {0, 0}), b = rest_version(2, {1, 0});
  SimNetwork network{1, kBegin, {}};
  SimBus bus{network}, outside{network};
  CoordinatorNode node;
  msg::CoordinatorState state;
  std::vector<msg::Verdict> verdicts;
};

TEST_CASE("a coordinator answers registrations and proposals on the robot's channel") {
  Floor floor;
  floor.send(topics::kRegistration, registration_of(floor.a, floor.node.coordinator().epoch()));
  REQUIRE(floor.verdicts.size() == 1);
  CHECK(floor.verdicts[0].robot() == 1);
  CHECK(floor.verdicts[0].header().sender() == static_cast<std::uint32_t>(Sender::kCoordinator));
  CHECK(floor.verdicts[0].header().incarnation() == 5);
  floor.register_both();
  floor.send(topics::kProposal, floor.proposal());
  REQUIRE(floor.verdicts.size() == 1);
  CHECK(floor.verdicts[0].granted_version() == 10);
  CHECK(drops_of(floor.node).total() == 0);
}

TEST_CASE("messages that cannot be decoded are counted, not answered, and change nothing") {
  Floor floor;
  floor.register_both();
  const Epoch epoch = floor.node.coordinator().epoch();
  SECTION("a proposal from another sender") {
    auto proposal = floor.proposal();
    proposal.header().sender(2);
    floor.send(topics::kProposal, proposal);
  }
  SECTION("a registration from another sender") {
    auto registration = registration_of(floor.a, epoch, 2);
    registration.header().sender(2);
    floor.send(topics::kRegistration, registration);
  }
  auto robot_report =
      make_report(continued(floor.a, 10, 1001, {0, 3}), 1001);  // this fact contradicts the ledger
  SECTION("a fact from another sender") {
    robot_report.header().sender(2);
    floor.send(topics::kFeedback, robot_report);
  }
  SECTION("a fact on another robot's channel") { floor.send(topics::kFeedback, robot_report, 2); }
  SECTION("a fact without a position") {
    robot_report.x_m(kNan);
    floor.send(topics::kFeedback, robot_report);
  }
  SECTION("a fact without a version") {
    robot_report.executing().x_m(kNan);
    floor.send(topics::kFeedback, robot_report);
  }
  msg::CoordinatorState other;
  other.coordinator(3);
  other.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + 3);
  other.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  SECTION("a heartbeat with an implausible epoch") {
    other.epoch(Epoch{1} << 61);
    floor.send(topics::kCoordinator, other);
  }
  SECTION("a heartbeat with an unknown role reason") {
    other.epoch(epoch + 1);
    other.role_reason(static_cast<msg::RoleReason>(99));
    floor.send(topics::kCoordinator, other);
  }
  SECTION("a heartbeat with an unknown mode") {
    other.epoch(epoch + 1);
    other.coordinator_mode(static_cast<msg::CoordinatorMode>(99));
    floor.send(topics::kCoordinator, other);
  }
  floor.run();
  CHECK(drops_of(floor.node).total() == 1);
  CHECK(floor.verdicts.empty());
  CHECK(floor.node.coordinator().epoch() == epoch);
  CHECK(floor.node.coordinator().is_granting());
  for (const RobotId robot : {1, 2}) {
    REQUIRE(floor.node.coordinator().ledger().versions(robot).size() == 1);
    CHECK(floor.node.coordinator().ledger().versions(robot)[0].number == 0);
  }
}

TEST_CASE("malformed candidates and registrations are answered and counted") {
  Floor floor;
  floor.register_both();
  SECTION("a proposal without candidates") {
    auto proposal = floor.proposal();
    proposal.candidate_count(0);
    floor.send(topics::kProposal, proposal);
  }
  SECTION("a registration of an absent robot with a version") {
    auto registration = registration_of(floor.a, floor.node.coordinator().epoch(), 2);
    registration.is_absent(true);
    floor.send(topics::kRegistration, registration);
  }
  floor.run();
  REQUIRE(floor.verdicts.size() == 1);
  CHECK(floor.verdicts[0].reasons()[0] == msg::Reason::REASON_MALFORMED);
  CHECK(drops_of(floor.node).total() == 1);
}

TEST_CASE("an empty registration is answered with all orders and does not count as malformed") {
  Floor floor;
  auto registration = registration_of(floor.a, floor.node.coordinator().epoch());
  registration.knows_orders(true);
  floor.send(topics::kRegistration, registration);
  floor.send(topics::kRegistration, registration_of(floor.b, floor.node.coordinator().epoch()));
  floor.run_for(std::chrono::milliseconds(300));
  const std::size_t verdicts = floor.verdicts.size();
  int told = 0;
  floor.outside.subscribe(topics::kOrderMemory, [&](const msg::OrderMemory& page) {
    told += page.is_complete() && page.page_count() > 0;
  });
  floor.run_for(std::chrono::milliseconds(200));
  told = 0;
  auto asking = registration_of(floor.a, floor.node.coordinator().epoch(), 2);
  asking.version_count(0);
  const Time begin = floor.network.now();
  for (int i = 0; i < 8; ++i) {
    floor.send(topics::kRegistration, asking);
    floor.run_for(std::chrono::milliseconds(60));
  }
  // The coordinator announces the orders once per second anyway.
  REQUIRE(floor.network.now() - begin < std::chrono::seconds(3));
  CHECK(told >= 8);
  CHECK(floor.verdicts.size() == verdicts);
  CHECK(drops_of(floor.node).total() == 0);
  CHECK(floor.node.coordinator().is_granting());
}

TEST_CASE(
    "a robot's report of an implausible obeyed epoch is counted and does not change the coordinator's "
    "epoch") {
  Floor floor;
  floor.register_both();
  const Epoch epoch = floor.node.coordinator().epoch();
  auto robot_report = make_report(floor.a, 1000);
  robot_report.obeyed_epoch(Epoch{1} << 61);
  floor.send(topics::kFeedback, robot_report);
  CHECK(drops_of(floor.node).total() == 1);
  CHECK(floor.node.coordinator().epoch() == epoch);
}

struct Attested : Floor {
  LogEvents events{node};
  Attested() { send(topics::kRegistration, registration_of(b, node.coordinator().epoch())); }
  void attest(RobotId robot, Sender sender = Sender::kOperator) {
    msg::AbsenceAttestation message;
    message.robot(robot);
    message.header().sender(static_cast<std::uint32_t>(sender));
    send(topics::kAttestation, message);
  }
};

TEST_CASE("a coordinator logs that an operator attests the absence of a silent robot, and starts to grant") {
  Attested floor;
  floor.attest(1);
  CHECK(floor.node.coordinator().is_granting());
  CHECK(floor.events.count("an operator attests that robot 1 is absent") == 1);
  CHECK(floor.state.absent() == 1);
  CHECK(floor.state.notices().empty());
}

TEST_CASE(
    "an attestation is ignored if the robot was just heard or is not missing, or if the sender is not an "
    "operator") {
  Attested floor;
  SECTION("the robot was just heard") {
    floor.send(topics::kFeedback, make_report(floor.a, 1000));
    floor.attest(1);
    CHECK(floor.events.count("robot 1 reports that it is on the floor") == 1);
  }
  SECTION("the robot has registered") { floor.attest(2); }
  SECTION("the robot is not on the roster") { floor.attest(77); }
  SECTION("the sender is not an operator") {
    floor.attest(1, Sender::kVision);
    CHECK(drops_of(floor.bus).total(DropReason::kForgedSender) == 1);
  }
  CHECK_FALSE(floor.node.coordinator().is_granting());
}

TEST_CASE("a coordinator reports its role, each registration, and when it starts to grant") {
  Floor floor;
  const LogEvents events(floor.node);
  CHECK(events.count("begins epoch " + std::to_string(floor.node.coordinator().epoch()) + ": started") == 1);
  floor.register_both();
  CAPTURE(events.text());
  CHECK(events.count("robot 1 is registered by its agent of incarnation") == 1);
  CHECK(events.count("robot 2 is registered by its agent of incarnation") == 1);
  CHECK(events.count("granting in epoch") == 1);
  CHECK(events.all()[1].robot == 1);
  CHECK(events.all()[1].level == LogLevel::kDebug);
  floor.network.run_until(floor.network.now() + std::chrono::seconds(5));
  CHECK(events.all().size() == 4);
}

TEST_CASE("a coordinator reports once per second which robots it is waiting for") {
  Floor floor;
  const LogEvents events(floor.node);
  floor.send(topics::kRegistration, registration_of(floor.a, floor.node.coordinator().epoch()));
  floor.network.run_until(floor.network.now() + std::chrono::milliseconds(3500));
  CAPTURE(events.text());
  CHECK(events.count("waiting for robots 2 to register") == 3);
}

TEST_CASE("a coordinator reports when robots are quarantined and released") {
  Floor floor;
  floor.register_both();
  const LogEvents events(floor.node);
  floor.send(topics::kFeedback, make_report(continued(floor.a, 10, 1001, {0, 3}), 1001));
  CAPTURE(events.text());
  CHECK(events.count("robot 1 executes version 10, which it was never granted") == 1);
  CHECK(events.count("robot 1 is quarantined") == 1);
  for (int i = 0; i < 60; ++i) floor.send(topics::kFeedback, make_report(floor.a, 1000));
  CHECK(events.count("robot 1 is released from quarantine") == 1);
}

TEST_CASE("a coordinator reports why it stands by") {
  Floor floor;
  const LogEvents events(floor.node);
  msg::CoordinatorState other;
  other.coordinator(3);
  other.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + 3);
  other.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  other.epoch(floor.node.coordinator().epoch() + 1000);
  floor.send(topics::kCoordinator, other);
  CAPTURE(events.text());
  CHECK(events.count("stands by: coordinator 3 has the higher epoch " + std::to_string(other.epoch())) == 1);
}

TEST_CASE("a displaced robot's position is published after every world state") {
  Floor floor;
  floor.register_both();
  msg::WorldState world = world_of({1}, floor.network.now());
  const auto see = [&](double x) {
    world.valid_at_ns(to_ns(floor.network.now()));
    world.robots()[0].observed_at_ns(to_ns(floor.network.now()));
    world.robots()[0].observed_x_m(x);
    floor.send(topics::kWorld, world);
  };
  see(0);
  CHECK(floor.state.notices().empty());
  CHECK(floor.state.watched_until_ns() == world.valid_at_ns());
  const LogEvents events(floor.node);
  see(0.3);
  REQUIRE(floor.state.notices().size() == 1);
  CHECK(floor.state.notices()[0].x_m() == 0.3);
  CHECK(events.count("robot 1 is displaced") == 1);
  see(0.4);
  CHECK(floor.state.notices()[0].x_m() == 0.4);
  world.header().sender(1);
  see(0.5);
  CHECK(floor.state.notices()[0].x_m() == 0.4);
  CHECK(drops_of(floor.bus).total(DropReason::kForgedSender) == 1);
}

TEST_CASE("a displaced robot whose position jumps is named with a speed that agents accept") {
  Floor floor;
  floor.register_both();
  msg::WorldState world = world_of({1}, floor.network.now());
  floor.send(topics::kWorld, world);
  world.robots()[0].observed_at_ns(world.robots()[0].observed_at_ns() + 1);
  world.robots()[0].observed_x_m(1);
  floor.send(topics::kWorld, world);
  REQUIRE(floor.state.notices().size() == 1);
  CHECK(floor.state.notices()[0].is_displaced());
  CHECK(floor.state.notices()[0].vx_mps() > 99);
  CHECK(decode(floor.state, floor.network.now()));
}

TEST_CASE("a world state from the future is counted, displaces no robot and does not count as watching") {
  Floor floor;
  floor.register_both();
  msg::WorldState world = world_of({1}, floor.network.now());
  msg::TrackedRobot& robot = world.robots()[0];
  robot.observed_x_m(0.3);
  // The message takes 0.2 to 0.6 ms to arrive. Two clocks may differ by 1 ms, and vision's may be ahead by
  // 0.1 s.
  const auto observe_early = [&](std::chrono::microseconds ahead) {
    world.valid_at_ns(to_ns(floor.network.now() + ahead));
    robot.observed_at_ns(to_ns(floor.network.now()));
    floor.send(topics::kWorld, world);
  };
  observe_early(std::chrono::microseconds(101'700));
  CHECK(floor.state.notices().empty());
  CHECK(floor.state.watched_until_ns() == 0);
  CHECK(drops_of(floor.node).total(DropReason::kFutureWorld) == 1);
  observe_early(std::chrono::microseconds(101'100));
  CHECK(floor.state.notices().size() == 1);
  CHECK(floor.state.watched_until_ns() == robot.observed_at_ns());
  CHECK(drops_of(floor.node).total() == 1);
}

TEST_CASE("a malformed observation is counted, and its world state does not count as watching") {
  Floor floor;
  floor.register_both();
  msg::WorldState world = world_of({1, 2}, floor.network.now());
  world.robots()[1].observed_x_m(kNan);
  floor.send(topics::kWorld, world);
  CHECK(floor.state.watched_until_ns() == 0);
  CHECK(drops_of(floor.node).total(DropReason::kMalformedObservation) == 1);
  world.robots()[1].observed_x_m(1);
  floor.send(topics::kWorld, world);
  CHECK(floor.state.watched_until_ns() == world.robots()[0].observed_at_ns());
}

TEST_CASE("a coordinator that stands by answers no messages") {
  Floor floor(true);
  floor.send(topics::kRegistration, registration_of(floor.a, 0));
  floor.send(topics::kProposal, floor.proposal());
  floor.send(topics::kFeedback, make_report(floor.a, 1000));
  CHECK(floor.verdicts.empty());
  CHECK_FALSE(floor.node.coordinator().is_active());
}

TEST_CASE(
    "a coordinator that has yielded publishes its state at a standby's rate, even if robots were silent") {
  Floor floor;
  floor.register_both();
  const auto see = [&] { floor.send(topics::kWorld, world_of({}, floor.network.now())); };
  // Robot 1 falls silent while it should move.
  floor.send(topics::kFeedback, make_report(floor.a, 1000));
  const double now_s = to_seconds(floor.network.now().time_since_epoch());
  const Version moving = continued(floor.a, 10, now_s + 0.1, {0, 3}, 0.3);
  floor.send(topics::kProposal, proposal_of({moving}, floor.node.coordinator().epoch()));
  for (int i = 0; i < 4; ++i) see();
  REQUIRE(floor.node.coordinator().has_uncontrolled_robots());
  msg::CoordinatorState other;
  other.coordinator(1);
  other.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + 1);
  other.epoch(floor.node.coordinator().epoch() + 1);
  other.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  floor.send(topics::kCoordinator, other);
  REQUIRE_FALSE(floor.node.coordinator().is_active());
  int published = 0;
  floor.outside.subscribe(topics::kCoordinator, [&](const msg::CoordinatorState& message) {
    published += message.coordinator() == 0 ? 1 : 0;
  });
  const Time begin = floor.network.now();
  for (int i = 0; i < 30; ++i) {
    see();
    floor.send(topics::kCoordinator, other);
  }
  CAPTURE(published, to_seconds(floor.network.now() - begin));
  CHECK(published <= 1 + to_seconds(floor.network.now() - begin) / 0.2);
}

TEST_CASE("a coordinator keeps working after its clock is set back") {
  Floor floor;
  floor.register_both();
  floor.send(topics::kFeedback, make_report(floor.a, 1000));
  floor.bus.set_clock({std::chrono::seconds(-5), 0, floor.network.now()});
  floor.run();
  const Epoch epoch = floor.node.coordinator().epoch();
  CHECK(floor.node.coordinator().is_granting());
  floor.send(topics::kProposal, floor.proposal());
  REQUIRE(floor.verdicts.size() == 1);
  CHECK(floor.verdicts[0].granted_version() == 10);
  CHECK(floor.node.coordinator().epoch() == epoch);
}

TEST_CASE("a coordinator announces all orders when its epoch begins") {
  Floor floor(true);
  int whole_memories = 0;
  std::optional<Time> begun_at, told_at;
  floor.outside.subscribe(topics::kCoordinator, [&](const msg::CoordinatorState& state) {
    if (state.epoch() != 0 && !begun_at) begun_at = time_from_ns(state.header().stamp_ns());
  });
  floor.outside.subscribe(topics::kOrderMemory, [&](const msg::OrderMemory& page) {
    if (page.page_count() == 0) return;
    ++whole_memories;
    if (begun_at && !told_at) told_at = time_from_ns(page.header().stamp_ns());
  });
  while (!begun_at && floor.network.now() < kBegin + std::chrono::seconds(5)) {
    floor.send(topics::kFeedback, make_report(floor.a, 1000), 1);
    floor.send(topics::kFeedback, make_report(floor.b, 1000), 2);
  }
  floor.run();
  REQUIRE(begun_at);
  REQUIRE(told_at);
  CHECK(*told_at == *begun_at);
  // The coordinator repeats the orders until all agents have registered, in case some have missed them.
  whole_memories = 0;
  for (int i = 0; i < 20; ++i) floor.run();
  CHECK(whole_memories >= 2);
}

msg::Order hold_of(RobotId robot, OrderNumber number) {
  msg::Order hold;
  hold.robot(robot);
  hold.header().sender(1'000'001);
  hold.terms().order_kind(msg::OrderKind::ORDER_HOLD);
  hold.terms().order_number(number);
  return hold;
}

TEST_CASE("a hold stops its robot immediately and is confirmed when the robot's agent reports it") {
  Floor floor;
  floor.register_both();
  std::vector<msg::OrderAnswer> answers;
  floor.outside.subscribe(topics::kOrderAnswer,
                          [&](const msg::OrderAnswer& answer) { answers.push_back(answer); });
  floor.send(topics::kOrder, hold_of(1, 1000));
  CHECK(answers.empty());
  floor.send(topics::kProposal, floor.proposal());
  REQUIRE(floor.verdicts.size() == 1);
  CHECK(floor.verdicts[0].reasons()[0] == msg::Reason::REASON_HELD);
  msg::OrderStatus status;
  status.robot(1);
  status.header().sender(1);
  status.is_held(true);
  floor.send(topics::kOrderStatus, status);
  CHECK(answers.empty());
  auto robot_report = make_report(floor.a, 1001);
  robot_report.obeyed_epoch(floor.node.coordinator().epoch());
  floor.send(topics::kFeedback, robot_report);
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].order_number() == 1000);
  CHECK(answers[0].result() == msg::OrderResult::RESULT_REMEMBERED);
}

TEST_CASE(
    "a drive order is announced until an agent or another coordinator remembers it, and then answered") {
  Floor floor;
  floor.register_both();
  std::vector<msg::OrderAnswer> answers;
  std::vector<msg::OrderMemory> announced;
  floor.outside.subscribe(topics::kOrderAnswer,
                          [&](const msg::OrderAnswer& answer) { answers.push_back(answer); });
  floor.outside.subscribe(topics::kOrderMemory, [&](const msg::OrderMemory& page) {
    if (page.page_count() == 0) announced.push_back(page);
  });
  Order go{msg::OrderKind::ORDER_GO, 1, 1'000'001, 1000};
  go.goals = {{{1, 1}}};
  for (std::size_t times = 1; times <= 3; ++times) {
    floor.send(topics::kOrder, encode(go));
    CHECK(announced.size() == times);
  }
  CHECK(answers.empty());
  REQUIRE(decode(announced.back(), floor.network.now()));
  const auto page = *decode(announced.back(), floor.network.now());
  REQUIRE(page.orders.size() == 1);
  CHECK(page.orders[0].order.number == 1000);
  const bool by_agent = GENERATE(true, false);
  CAPTURE(by_agent);
  const auto remember = [&](std::uint32_t process) {
    msg::OrderMemory memory = encode(page.orders, true, by_agent).front();
    memory.process(process);
    memory.header().sender(process);
    floor.send(by_agent ? topics::kAgentOrders : topics::kOrderMemory, memory);
  };
  remember(7);  // process 7 is not on the roster
  CHECK(answers.empty());
  remember(by_agent ? 2 : static_cast<std::uint32_t>(Sender::kCoordinator) + 1);
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].order_number() == 1000);
  CHECK(answers[0].result() == msg::OrderResult::RESULT_REMEMBERED);
}

TEST_CASE("an order that changes nothing or is refused is answered immediately") {
  Floor floor;
  floor.register_both();
  std::vector<msg::OrderAnswer> answers;
  floor.outside.subscribe(topics::kOrderAnswer,
                          [&](const msg::OrderAnswer& answer) { answers.push_back(answer); });
  floor.send(topics::kOrder, encode(Order{msg::OrderKind::ORDER_CANCEL, 99, 1'000'001, 1000}));
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].result() == msg::OrderResult::RESULT_UNKNOWN_ROBOT);
  // The operator's later resume already lifts everything that the client's resume would lift.
  floor.send(topics::kOrder, encode(Order{msg::OrderKind::ORDER_RESUME, kAllRobots,
                                          static_cast<ClientId>(Sender::kOperator), 2000}));
  answers.clear();
  floor.send(topics::kOrder, encode(Order{msg::OrderKind::ORDER_RESUME, 1, 1'000'001, 1500}));
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].result() == msg::OrderResult::RESULT_REMEMBERED);
}

}  // namespace sidestep::coordinator_node_test
