// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/sent_messages.hpp"

#include <fmt/format.h>
#include <limits>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/protocol/process_names.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::sent_messages_test {

using namespace std::chrono_literals;

Scenario pair() {
  return parse_scenario("field: {length_m: 6, width_m: 4}\ncircle: {count: 2, spacing_m: 3}\n", "pair.yaml");
}

constexpr RobotId kRobot = 1;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::uint32_t id(Sender sender) { return static_cast<std::uint32_t>(sender); }

struct Judgement {
  Judgement() { observer.become_observer(); }
  SimNetwork network{1, Time{1000s}, NetworkSpec{}};
  SimBus observer{network}, sender{network};
  const SentMessages sent{observer, pair()};
};

/// Sends the message, which is well formed, and then what `spoil` makes of it.
template <typename Message, typename Spoil>
void check_named(const Topic<Message>& topic, std::uint32_t sender, Message message, Spoil spoil) {
  INFO(topic.name);
  Judgement judgement;
  auto writer = judgement.sender.advertise(topic, kRobot);
  message.header().sender(sender);
  writer.publish(message, judgement.sender.now());
  judgement.network.run_until(Time{1001s});
  CHECK(judgement.sent.failures() == std::vector<std::string>{});
  spoil(message);
  writer.publish(message, judgement.sender.now());
  judgement.network.run_until(Time{1002s});
  CHECK(judgement.sent.failures() ==
        std::vector<std::string>{fmt::format("1 malformed messages of {} on {}, the first at 1.000 s",
                                             process_name(sender), topic.name)});
}

TEST_CASE("malformed messages are counted by sender and topic, with the time of the first") {
  Judgement judgement;
  auto states = judgement.sender.advertise(topics::kCoordinator);
  judgement.network.run_until(Time{1003s});
  msg::CoordinatorState state;
  state.header().sender(id(Sender::kCoordinator));
  state.role_peer(kMaxRobots);
  for (int i = 0; i < 3; ++i) states.publish(state, judgement.sender.now());
  judgement.network.run_until(Time{1004s});
  CHECK(judgement.sent.failures() ==
        std::vector<std::string>{"3 malformed messages of coordinator on coordinator, the first at 3.000 s"});
}

TEST_CASE("a malformed message of an agent is named whatever its topic") {
  msg::Registration registration;
  registration.robot(kRobot);
  SECTION("registration of a robot") {
    registration.version_count(1);
    registration.versions()[0].robot(kRobot);
    check_named(topics::kRegistration, kRobot, registration, [](auto& m) { m.versions()[0].x_m(kNaN); });
  }
  SECTION("request for orders") {
    check_named(topics::kRegistration, kRobot, registration, [](auto& m) { m.robot(0); });
  }
  SECTION("proposal") {
    msg::Proposal proposal;
    proposal.robot(kRobot);
    proposal.candidate_count(2);
    for (int i : {0, 1}) proposal.candidates()[i].robot(kRobot);
    check_named(topics::kProposal, kRobot, proposal, [](auto& m) { m.candidates()[1].x_m(kNaN); });
  }
  SECTION("command") {
    msg::Command command;
    command.robot(kRobot);
    command.header().incarnation(1);
    check_named(topics::kCommand, kRobot, command, [](auto& m) { m.desired_heading_rad(kNaN); });
  }
  SECTION("orders") {
    msg::OrderMemory orders;
    orders.process(kRobot);
    check_named(topics::kAgentOrders, kRobot, orders, [](auto& m) { m.order_count(1); });
  }
  SECTION("course") {
    msg::Course course;
    course.robot(kRobot);
    course.planned_at_ns(1);
    check_named(topics::kCourse, kRobot, course, [](auto& m) { m.planned_at_ns(0); });
  }
  SECTION("offer of a course") {
    msg::CourseOffer offer;
    offer.by(kRobot);
    offer.planned_at_ns(1);
    offer.start_ns(1'000'000'000'000);
    offer.points().resize(2);
    check_named(topics::kCourseOffer, kRobot, offer, [](auto& m) { m.points()[1].x_m(10); });
  }
  SECTION("order status") {
    msg::OrderStatus status;
    status.robot(kRobot);
    check_named(topics::kOrderStatus, kRobot, status, [](auto& m) { m.remaining_s(kNaN); });
  }
}

TEST_CASE("a malformed message of a coordinator is named whatever its topic") {
  const std::uint32_t coordinator = id(Sender::kCoordinator);
  SECTION("state") {
    msg::CoordinatorState state;
    state.notices().emplace_back().is_displaced(true);
    check_named(topics::kCoordinator, coordinator, state, [](auto& m) { m.notices()[0].vx_mps(1000); });
  }
  SECTION("ledger") {
    msg::LedgerPage page;
    page.versions().resize(2);
    check_named(topics::kLedger, coordinator, page, [](auto& m) { m.versions()[1].x_m(kNaN); });
  }
  SECTION("header of a page of the ledger") {
    check_named(topics::kLedger, coordinator, msg::LedgerPage{}, [](auto& m) { m.page_index(kMaxRobots); });
  }
  SECTION("verdict") {
    msg::Verdict verdict;
    verdict.robot(kRobot);
    check_named(topics::kVerdict, coordinator, verdict, [](auto& m) { m.robot(0); });
  }
  SECTION("orders") {
    msg::OrderMemory orders;
    orders.process(coordinator);
    check_named(topics::kOrderMemory, coordinator, orders, [](auto& m) { m.order_count(1); });
  }
  SECTION("relayed course") {
    msg::Course course;
    course.robot(kRobot);
    course.planned_at_ns(1);
    check_named(topics::kSharedCourse, coordinator, course, [](auto& m) { m.planned_at_ns(0); });
  }
  SECTION("relayed offer of a course") {
    msg::CourseOffer offer;
    offer.planned_at_ns(1);
    offer.start_ns(1'000'000'000'000);
    offer.points().resize(2);
    check_named(topics::kSharedCourseOffer, coordinator, offer, [](auto& m) { m.by(kMaxRobots); });
  }
}

TEST_CASE("a malformed message of vision or of a robot is named whatever its topic") {
  SECTION("world state") {
    msg::WorldState world;
    world.robots().resize(2);
    check_named(topics::kWorld, id(Sender::kVision), world, [](auto& m) { m.robots()[1].vx_mps(1000); });
  }
  SECTION("obstacles") {
    check_named(topics::kObstacles, id(Sender::kVision), msg::ObstacleList{},
                [](auto& m) { m.complete_within_m(-1); });
  }
  SECTION("feedback") {
    msg::Feedback feedback;
    feedback.robot(kRobot);
    feedback.executing().robot(kRobot);
    check_named(topics::kFeedback, kRobot, feedback, [](auto& m) { m.lead_ns(-1); });
  }
}

TEST_CASE("a system without faults sends no malformed message on any topic") {
  const Scenario scenario = pair();
  SimSystem system(scenario, 1);
  const SentMessages sent(system.observer_bus(), scenario);
  system.run_until(system.begin() + 5s);
  CHECK(system.metrics().report().grants > 50);
  CHECK(sent.failures() == std::vector<std::string>{});
}

}  // namespace sidestep::sent_messages_test
