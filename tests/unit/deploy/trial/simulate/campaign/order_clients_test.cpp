// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/order_clients.hpp"

#include <cmath>

#include "simulator/world/disturbance_codec.hpp"
#include "tests/catch.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::order_clients_test {

using namespace std::chrono_literals;

constexpr ClientId kOther = kOtherClient;

struct Trial {
  SimSystem system{waiting_robots(2), 1};
  OrderClients clients{system, waiting_robots(2)};
  Trial() { system.run_for(2s); }
  void give(msg::OrderKind kind, RobotId robot, ClientId client, std::vector<Goal> goals = {}) {
    Order order{kind, robot, client};
    order.goals = std::move(goals);
    clients.give(order);
  }
  /// Sends an operator's resume of all robots without telling the judge.
  void resume_unknown_to_judge() {
    system.send(
        {msg::OrderKind::ORDER_RESUME, kAllRobots, kOperator, static_cast<OrderNumber>(to_ns(system.now()))});
  }
};

TEST_CASE("a trial fails if a held robot moves, but not if it was resumed") {
  const bool is_resumed = GENERATE(false, true);
  const RobotId scope = GENERATE(RobotId{0}, kAllRobots);
  CAPTURE(is_resumed, scope);
  Trial trial;
  trial.give(msg::OrderKind::ORDER_HOLD, scope, kClient);
  trial.system.run_for(4s);
  CHECK(trial.clients.failures().empty());
  if (is_resumed)
    trial.give(msg::OrderKind::ORDER_RESUME, 0, kClient);
  else
    trial.resume_unknown_to_judge();
  trial.give(msg::OrderKind::ORDER_GO, 0, kOther, {{{1, 1}}});
  trial.system.run_for(3s);
  CHECK(trial.clients.failures().empty() == is_resumed);
}

TEST_CASE("a trial does not fail if a carried robot pushes a held robot") {
  Trial trial;
  trial.give(msg::OrderKind::ORDER_HOLD, kAllRobots, kClient);
  trial.system.run_for(4s);
  RobotDisturbance carry;
  carry.robot = 1;
  carry.kind = msg::DisturbanceKind::DISTURBANCE_CARRY;
  carry.place_m = Vec2(-2.1, -1.5);  // through robot 0
  carry.duration = 5s;
  msg::Disturbance message = encode(carry);
  Vec2 place_m{-2, -1.5};
  trial.system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) {
    for (const msg::TrueRobotState& body : truth.robots()) {
      if (body.robot() == 0) place_m = {body.x_m(), body.y_m()};
    }
  });
  trial.system.disturb(message);
  trial.system.run_for(8s);
  CHECK((place_m - Vec2(-2, -1.5)).norm() > 0.05);
  CHECK(trial.clients.failures().empty());
}

TEST_CASE("a trial does not fail while a held robot without power coasts to rest") {
  Trial trial;
  trial.give(msg::OrderKind::ORDER_GO, 0, kClient, {{{1.5, 1.5}}});
  trial.system.run_for(900ms);
  trial.give(msg::OrderKind::ORDER_HOLD, 0, kClient);
  trial.system.run_for(60ms);
  RobotDisturbance switch_off;
  switch_off.robot = 0;
  switch_off.kind = msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF;
  trial.system.disturb(encode(switch_off));
  double speed_mps = 0;
  trial.system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) {
    for (const msg::TrueRobotState& body : truth.robots())
      if (body.robot() == 0) speed_mps = std::hypot(body.vx_mps(), body.vy_mps());
  });
  trial.system.run_for(OrderClients::kTimeToRest + 200ms);
  REQUIRE(speed_mps > 0.05);
  trial.system.run_for(4s);
  CHECK(speed_mps == 0);
  for (const std::string& failure : trial.clients.failures()) UNSCOPED_INFO(failure);
  CHECK(trial.clients.failures().empty());
}

TEST_CASE("the positions of robots of a second simulator do not fail a trial, and earlier failures count") {
  const bool has_moved = GENERATE(false, true);
  CAPTURE(has_moved);
  Trial trial;
  trial.give(msg::OrderKind::ORDER_GO, 0, kOther, {{{-1, -1.5}}});  // away from where simulators begin
  trial.system.run_for(5s);
  trial.give(msg::OrderKind::ORDER_HOLD, 0, kClient);
  trial.system.run_for(4s);
  if (has_moved) {
    trial.resume_unknown_to_judge();
    trial.give(msg::OrderKind::ORDER_GO, 0, kOther, {{{1, 1}}});
    trial.system.run_for(6s);
  }
  const std::vector<std::string> failures = trial.clients.failures();
  CHECK(failures.empty() != has_moved);
  trial.system.pause("simulator", 3s, 1000);
  trial.system.restart(second_process("simulator"));
  trial.system.run_for(2s);
  REQUIRE(trial.system.was_second_simulator_accepted());
  CHECK(trial.clients.failures() == failures);
}

TEST_CASE("a trial fails while a coordinator has forgotten an order that its client has not repeated") {
  Trial trial;
  trial.give(msg::OrderKind::ORDER_GO, 0, kClient, {{{1, 1}}});
  trial.system.run_for(2s);
  CHECK(trial.clients.failures().empty());
  for (const std::string& process : {std::string("coordinator"), agent_process(0), agent_process(1)})
    trial.system.kill(process);
  for (const std::string& process : {std::string("coordinator"), agent_process(0), agent_process(1)})
    trial.system.restart(process);
  bool has_failed = false;
  for (int i = 0; i < 200 && !has_failed; ++i) {
    trial.system.run_for(50ms);
    has_failed = !trial.clients.failures().empty();
  }
  CHECK(has_failed);
  trial.system.run_for(10s);
  CHECK(trial.clients.failures().empty());
}

TEST_CASE("a trial does not fail because an isolated coordinator forgot an order in a restart") {
  Scenario scenario = waiting_robots(2);
  scenario.coordinators = 2;
  SimSystem system{scenario, 1};
  OrderClients clients{system, scenario};
  system.run_for(2s);
  for (const std::string& process : system_process_names(scenario)) {
    LinkQuality cut;
    cut.is_cut = true;
    if (process != "coordinator 1") system.set_link(process, "coordinator 1", cut);
  }
  system.kill("coordinator 1");
  Order order{msg::OrderKind::ORDER_GO, 0, kClient};
  order.goals = {{{1, 1}}};
  clients.give(order);
  system.run_for(1s);
  REQUIRE(clients.failures().size() == 1);
  CHECK_THAT(clients.failures()[0],
             StartsWith("coordinator 1 has forgotten order ") && EndsWith(" of client 1000001 to robot 0"));
  system.restart("coordinator 1");
  system.run_for(3s);
  CHECK(clients.failures().empty());
}

TEST_CASE("a trial does not fail because a permanently isolated coordinator never heard an order") {
  Scenario scenario = waiting_robots(2);
  scenario.coordinators = 2;
  SimSystem system{scenario, 1};
  OrderClients clients{system, scenario};
  system.run_for(2s);
  LinkQuality cut;
  cut.is_cut = true;
  for (const std::string& process : system_process_names(scenario))
    if (process != "coordinator 1") system.set_link(process, "coordinator 1", cut);
  system.pause("coordinator 1", 1s, 0);
  Order order{msg::OrderKind::ORDER_GO, 0, kClient};
  order.goals = {{{-1.8, -1.5}}};
  clients.give(order);
  system.run_for(1500ms);
  CHECK(clients.failures().size() == 1);
  clients.stop_judging("coordinator 1");
  CHECK(clients.failures().empty());
}

TEST_CASE("a trial fails if an order is not answered") {
  Trial trial;
  trial.system.kill("coordinator");
  trial.give(msg::OrderKind::ORDER_HOLD, 0, kOperator);
  trial.give(msg::OrderKind::ORDER_HOLD, 0, kClient);
  trial.system.run_for(2s);
  CHECK(trial.clients.failures() == std::vector<std::string>{"the operator got no answer to an order",
                                                             "client 1000001 got no answer to an order"});
}

}  // namespace sidestep::order_clients_test
