// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"
#include "deploy/audit/metrics/progress.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"
#include "deploy/audit/metrics/straight_line_time.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/metrics/run_metrics_messages.hpp"

namespace sidestep::run_metrics_test {

TEST_CASE("arrival time runs from the first grant until the robot settles at its last goal") {
  RunMetrics metrics(kTwo);
  metrics.on_coordinator(state(1, 0.5, kRegistering));
  CHECK_FALSE(metrics.granting_since());
  metrics.on_coordinator(state(2, 1.0, kGranting));
  metrics.on_coordinator(state(3, 2.0, kGranting));
  CHECK(metrics.granting_since() == after(1));

  metrics.on_truth(
      truth(1, 2.0, {body(3, 0.99, 0, 0.5), body(7, 0.5, 1)}));             // robot 3 drives through its goal
  metrics.on_truth(truth(2, 3.0, {body(3, 1.01, 0), body(7, 1, 1, 1)}));    // robot 3 rests
  metrics.on_truth(truth(3, 3.5, {body(3, 1.03, 0), body(7, 1.5, 1, 1)}));  // robot 3 is pushed
  metrics.on_truth(truth(4, 4.0, {body(3, 1.019, 0, 0.019), body(7, 1.99, 1)}));  // robot 3 returns
  metrics.on_truth(truth(5, 5.0, {body(3, 1, 0), body(7, 2, 1)}));
  CHECK(metrics.arrived() == 0);
  metrics.on_status(status(3, 1, kArrived));
  CHECK(metrics.arrived() == 1);
  CHECK_FALSE(metrics.all_arrived());
  CHECK_FALSE(metrics.report().makespan_s);
  CHECK_FALSE(metrics.report().arrival_s.at(7));
  CHECK_THAT(metrics.report().failure_reason(), Equals("1 of 2 arrived"));
  metrics.on_status(status(7, 1, kArrived));
  CHECK(metrics.all_arrived());

  const Report report = metrics.report();
  CHECK(report.failure_reason().empty());
  CHECK(report.arrival_s.at(3) == Approx(3));
  CHECK(report.arrival_s.at(7) == Approx(3));
  CHECK(report.makespan_s == Approx(3));
  CHECK(report.mean_arrival_s == Approx(3));
  CHECK(report.robot_time_s == Approx(4));
  CHECK(report.max_reference_error_m == Approx(0.001));
  CHECK(report.min_clearance_m == Approx(0.3));
  const double expected = (3 / straight_line_time_s(kTwo.robots[0], kTwo.limits) +
                           3 / straight_line_time_s(kTwo.robots[1], kTwo.limits)) /
                          2;
  CHECK(report.straight_line_time_ratio == Approx(expected));
}

TEST_CASE("a robot that leaves its goal has not arrived") {
  RunMetrics metrics(kTwo);
  metrics.on_coordinator(state(1, 0, kGranting));
  metrics.on_status(status(3, 1, kArrived));
  metrics.on_truth(truth(1, 1, {body(3, 1, 0)}));
  CHECK(metrics.arrived() == 1);
  metrics.on_truth(truth(2, 2, {body(3, 1.1, 0)}));
  CHECK(metrics.arrived() == 0);
  metrics.on_truth(truth(3, 3, {body(3, 1, 0)}));
  metrics.on_status(status(3, 2, kDriving));
  CHECK(metrics.arrived() == 0);
}

TEST_CASE("a robot without a goal has not arrived until it has carried out an order") {
  const Scenario scenario = parse_scenario(
      "robots:\n- {id: 3, start_m: [0, 0], goals_m: [[1, 0]]}\n- {id: 7, start_m: [0, 1]}\n", "mixed.yaml");
  constexpr auto kWithoutOrder = msg::AgentState::AGENT_WITHOUT_ORDER;
  RunMetrics metrics(scenario);
  metrics.on_coordinator(state(1, 0, kGranting));
  metrics.on_truth(truth(1, 1, {body(3, 1, 0), body(7, 0, 1)}));
  metrics.on_status(status(3, 1, kArrived));
  CHECK_FALSE(metrics.all_arrived());  // nothing is known of robot 7
  metrics.on_status(status(7, 1, kWithoutOrder));
  CHECK(metrics.arrived() == 1);
  CHECK(metrics.without_goal() == 1);
  CHECK(metrics.all_arrived());
  CHECK_THAT(progress_line(metrics, time_from_ns(0)),
             ContainsSubstring("1 of 1 arrived  1 without a goal  "));
  CHECK_FALSE(metrics.progress()[1].arrived);
  CHECK(metrics.progress()[1].is_done);
  const Report idle = metrics.report();
  CHECK(idle.failure_reason().empty());
  CHECK(idle.arrival_s.at(3) == Approx(1));
  CHECK_FALSE(idle.arrival_s.at(7));
  CHECK(idle.mean_arrival_s == Approx(1));
  CHECK(idle.makespan_s == Approx(1));

  metrics.on_status(status(7, 2, kDriving));
  CHECK(metrics.without_goal() == 0);
  CHECK_FALSE(metrics.all_arrived());
  metrics.on_status(status(7, 3, kArrived));
  CHECK(metrics.arrived() == 2);
  CHECK(metrics.report().arrival_s.at(7));
}

TEST_CASE("a run in which no robot has a goal has no arrivals") {
  const Scenario scenario = parse_scenario("robots:\n- {id: 3, start_m: [0, 0]}\n", "idle.yaml");
  RunMetrics metrics(scenario);
  metrics.on_coordinator(state(1, 0, kGranting));
  metrics.on_truth(truth(1, 1, {body(3, 0, 0)}));
  metrics.on_status(status(3, 1, msg::AgentState::AGENT_WITHOUT_ORDER));
  CHECK(metrics.all_arrived());
  CHECK(metrics.report().arrived == 0);
  CHECK(metrics.report().without_goal == 1);
  CHECK_FALSE(metrics.report().makespan_s);
  CHECK_FALSE(metrics.report().mean_arrival_s);
}

TEST_CASE("each robot that has not finished a client's order is named with the cause") {
  const Scenario scenario = parse_scenario(
      "robots:\n- {id: 1, start_m: [0, 0]}\n- {id: 2, start_m: [0, 1]}\n- {id: 3, start_m: [0, 2]}\n"
      "- {id: 4, start_m: [1, 0]}\n- {id: 5, start_m: [1, 1]}\n- {id: 6, start_m: [1, 2]}\n"
      "- {id: 7, start_m: [2, 0]}\n",
      "ordered.yaml");
  RunMetrics metrics(scenario);
  metrics.on_coordinator(state(1, 0, kGranting));
  metrics.on_truth(truth(1, 1,
                         {body(1, 0, 0), body(2, 0, 1), body(3, 0, 2), body(4, 1, 0), body(5, 1, 1),
                          body(6, 1, 2, 0.5), body(7, 2, 0, 0.5)}));
  metrics.on_status(status(1, 1, msg::AgentState::AGENT_WITHOUT_ORDER));
  metrics.on_status(status(2, 1, kArrived));
  metrics.on_status(status(3, 1, msg::AgentState::AGENT_ABSENT));
  metrics.on_status(status(4, 1, kDriving));
  msg::OrderStatus blocked;
  blocked.robot(4);
  blocked.header().sender(4);
  blocked.client(static_cast<std::uint32_t>(Sender::kOperator));
  blocked.order_number(12);
  blocked.order_state(msg::OrderState::ORDER_BLOCKED);
  blocked.block_reason(msg::BlockReason::BLOCK_ZONE);
  blocked.blocker(1);
  blocked.remaining_s(-1);
  metrics.on_order_status(blocked);
  msg::AgentStatus under_way = status(5, 1, kDriving);
  under_way.distance_to_go_m(1.25);
  metrics.on_status(under_way);
  metrics.on_status(status(6, 1, kArrived));
  Report report = metrics.report();
  CHECK(report.arrived == 1);
  CHECK(report.without_goal == 1);
  REQUIRE(report.not_arrived.size() == 5);
  CHECK(report.not_arrived.at(3) == "it is off the floor");
  CHECK_THAT(report.not_arrived.at(4), StartsWith("zone 1 "));
  CHECK(report.not_arrived.at(5) == "it was under way, 1.25 m from its goal");
  CHECK(report.not_arrived.at(6) == "it was not seen at rest, although its agent reports arrival");
  CHECK(report.not_arrived.at(7) == "its agent has sent no status");
  CHECK_THAT(summary(report), ContainsSubstring("robot 3 has not arrived: it is off the floor\n"));
  // Whether that matters is the caller's decision.
  report.must_arrive = false;
  CHECK(report.failure_reason().empty());
  report.must_arrive = true;
  CHECK(report.failure_reason() == "1 of 6 arrived");
}

msg::WorldState world(double at_s, double x_m, double vx_mps) {
  msg::WorldState message;
  message.valid_at_ns(to_ns(after(at_s)));
  message.robots().resize(1);
  message.robots()[0].robot(3);
  message.robots()[0].x_m(x_m);
  message.robots()[0].vx_mps(vx_mps);
  return message;
}

TEST_CASE("without ground truth a robot has arrived if its agent and vision report it at its goal") {
  RunMetrics metrics(kTwo);
  CHECK_FALSE(metrics.has_seen_robots());
  metrics.on_status(status(3, 1, msg::AgentState::AGENT_ARRIVED));
  metrics.on_world_state(world(1, 0.9, 0));
  CHECK(metrics.has_seen_robots());
  CHECK(metrics.seen_at() == after(1));
  CHECK(metrics.arrived() == 0);
  metrics.on_world_state(world(2, kNaN, 0));
  CHECK(metrics.seen_at() == after(1));
  metrics.on_world_state(world(3, 1.02, 0.2));
  CHECK(metrics.arrived() == 1);
  metrics.on_world_state(world(2.5, 0, 0));  // arrives late
  CHECK(metrics.arrived() == 1);
  metrics.on_status(status(3, 2, msg::AgentState::AGENT_DRIVING));
  CHECK(metrics.arrived() == 0);
  // Ground truth takes precedence once it is received.
  metrics.on_status(status(3, 3, msg::AgentState::AGENT_ARRIVED));
  metrics.on_truth(truth(1, 4, {body(3, 0.5, 0)}));
  metrics.on_world_state(world(5, 1, 0));
  CHECK(metrics.arrived() == 0);
}

}  // namespace sidestep::run_metrics_test
