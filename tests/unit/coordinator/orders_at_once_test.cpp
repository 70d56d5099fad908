// SPDX-License-Identifier: Apache-2.0
// A hold takes effect as soon as its message arrives.
#include <vector>

#include "common/messaging/order_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/protocol/senders.hpp"
#include "coordinator/coordinator_node.hpp"
#include "tests/catch.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::orders_at_once_test {

using namespace std::chrono_literals;

constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);

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

TEST_CASE("a proposal right after a hold is refused, and a proposal right after the resume is granted") {
  const Scenario scenario = two_robots();
  SimNetwork network{1, time_from_ns(1'000'000'000'000), {}};
  SimBus bus{network}, outside{network};
  CoordinatorNode node(bus, scenario, {0, 5}, false);
  std::vector<msg::Verdict> verdicts;
  outside.subscribe(topics::kVerdict, 1, [&](const msg::Verdict& message) { verdicts.push_back(message); });
  auto registrations = outside.advertise(topics::kRegistration, 1);
  auto proposals = outside.advertise(topics::kProposal, 1);
  auto orders = outside.advertise(topics::kOrder);
  const auto run_for = [&](Duration duration) { network.run_until(network.now() + duration); };
  run_for(30ms);
  const Version a = rest_version(1, {0, 0}), b = rest_version(2, {1, 0});
  for (const Version& version : {a, b}) {
    msg::Registration registration = registration_of(version, node.coordinator().epoch());
    registrations.publish(registration, network.now());
    run_for(30ms);
  }
  REQUIRE(node.coordinator().is_granting());
  verdicts.clear();

  // Both waits together are shorter than a heartbeat period.
  const auto order_and_propose = [&](msg::OrderKind kind, OrderNumber number, VersionNumber version) {
    Order order{kind, 1, kOperator, number};
    msg::Order message = encode(order);
    orders.publish(message, network.now());
    run_for(1ms);
    msg::Proposal proposal = proposal_of({continued(a, version, 1001, {0, 3})}, node.coordinator().epoch());
    proposals.publish(proposal, network.now());
    run_for(1ms);
  };
  const auto now = static_cast<OrderNumber>(to_ns(network.now()));
  order_and_propose(msg::OrderKind::ORDER_HOLD, now, 10);
  REQUIRE(verdicts.size() == 1);
  CHECK(verdicts[0].granted_version() == 0);
  CHECK(verdicts[0].reasons().front() == msg::Reason::REASON_HELD);
  order_and_propose(msg::OrderKind::ORDER_RESUME, now + 1, 11);
  REQUIRE(verdicts.size() == 2);
  CHECK(verdicts[1].granted_version() == 11);
}

}  // namespace sidestep::orders_at_once_test
