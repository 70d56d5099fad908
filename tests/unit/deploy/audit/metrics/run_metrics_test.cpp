// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/run_metrics.hpp"

#include <cmath>
#include <limits>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/drop_codec.hpp"
#include "common/messaging/histogram_codec.hpp"
#include "deploy/audit/metrics/progress.hpp"
#include "tests/catch.hpp"

namespace sidestep::run_metrics_test {

const Scenario kTwo = parse_scenario(
    "robots:\n"
    "- {id: 3, start_m: [0, 0], goals_m: [[1, 0]]}\n"
    "- {id: 7, team: yellow, start_m: [0, 1], goals_m: [[0.5, 1], [2, 1]]}\n",
    "two.yaml");

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Time after(double seconds) { return kBegin + from_seconds(seconds); }

msg::Header header_of(std::uint64_t incarnation, std::uint64_t number, double at_s) {
  msg::Header header;
  header.incarnation(incarnation);
  header.message_number(number);
  header.stamp_ns(to_ns(after(at_s)));
  return header;
}

msg::TrueRobotState body(RobotId robot, double x_m, double y_m, double vx_mps = 0) {
  msg::TrueRobotState truth;
  truth.robot(robot);
  truth.x_m(x_m);
  truth.y_m(y_m);
  truth.vx_mps(vx_mps);
  truth.reference_error_m(0.001);
  return truth;
}

msg::GroundTruth truth(std::uint64_t number, double at_s, const std::vector<msg::TrueRobotState>& robots,
                       std::uint64_t incarnation = 1) {
  msg::GroundTruth message;
  message.header(header_of(incarnation, number, at_s));
  message.valid_at_ns(to_ns(after(at_s)));
  message.min_clearance_m(0.3);
  message.robots(robots);
  return message;
}

msg::AgentStatus status(RobotId robot, std::uint64_t number, msg::AgentState agent_state,
                        std::uint64_t incarnation = 1) {
  msg::AgentStatus message;
  message.robot(robot);
  message.header(header_of(incarnation, number, 0));
  message.agent_state(agent_state);
  return message;
}

msg::RobotNotice missing_notice(RobotId robot) {
  msg::RobotNotice notice;
  notice.robot(robot);
  notice.is_missing(true);
  return notice;
}

msg::CoordinatorState state(std::uint64_t number, double at_s, msg::CoordinatorMode mode,
                            std::uint64_t incarnation = 1) {
  msg::CoordinatorState message;
  message.header(header_of(incarnation, number, at_s));
  message.coordinator_mode(mode);
  return message;
}

constexpr auto kRegistering = msg::CoordinatorMode::COORDINATOR_REGISTERING;
constexpr auto kGranting = msg::CoordinatorMode::COORDINATOR_GRANTING;
constexpr auto kDriving = msg::AgentState::AGENT_DRIVING;
constexpr auto kFencing = msg::AgentState::AGENT_FENCING;
constexpr auto kArrived = msg::AgentState::AGENT_ARRIVED;

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

TEST_CASE("the straight-line time agrees with slow integration") {
  for (const double goal_m : {0.01, 0.5, 1.06, 1.07, 3.0, 12.0}) {
    CAPTURE(goal_m);
    MotionLimits limits;
    RobotSpec robot;
    robot.goals = {Goal{{goal_m, 0}, std::nullopt}};
    // The reference accelerates in small steps while the braking distance allows.
    double x = 0, v = 0, t = 0;
    const double dt = 1e-5;
    while (goal_m - x > 1e-6) {
      const bool may_accelerate = goal_m - x > v * v / (2 * limits.deceleration_mps2);
      v = may_accelerate ? std::min(limits.speed_mps, v + limits.acceleration_mps2 * dt)
                         : std::max(1e-3, v - limits.deceleration_mps2 * dt);
      x += v * dt;
      t += dt;
    }
    CHECK(straight_line_time_s(robot, limits) == Approx(t).margin(4e-3));
  }
}

TEST_CASE("counters are summed over the incarnations of agents, simulators and coordinators") {
  RunMetrics metrics(kTwo);
  const auto agent = [](std::uint64_t incarnation, std::uint64_t number, std::uint64_t base) {
    msg::AgentStatus message = status(3, number, kDriving, incarnation);
    message.proposals(base);
    message.grants(base + 1);
    message.denials(base + 2);
    message.cycles(base + 3);
    message.missed_cycles(base + 4);
    DurationHistogram histogram;
    for (std::uint64_t i = 0; i < base; ++i) histogram.add(std::chrono::milliseconds(incarnation));
    message.negotiation(encode(histogram));
    return message;
  };
  metrics.on_status(agent(1, 1, 10));
  metrics.on_status(agent(1, 2, 20));
  metrics.on_status(agent(2, 1, 5));
  metrics.on_status(agent(1, 3, 30));  // a late status of the first incarnation
  metrics.on_status(agent(1, 2, 20));  // a repetition of an older status
  CHECK(metrics.dropped_messages() == 1);

  auto seen = truth(9, 1, {}, 1);
  seen.contacts(2);
  seen.penetration_m_s(0.25);
  seen.firmware_violations(1);
  metrics.on_truth(seen);
  auto later = truth(1, 2, {}, 2);
  later.contacts(3);
  later.penetration_m_s(0.5);
  later.min_clearance_m(-0.01);
  metrics.on_truth(later);

  metrics.on_coordinator(state(1, 0, kGranting, 1));
  metrics.on_coordinator(state(1, 3, kRegistering, 2));

  const Report report = metrics.report();
  CHECK(report.proposals == 35);
  CHECK(report.grants == 37);
  CHECK(report.denials == 39);
  CHECK(report.cycles == 41);
  CHECK(report.missed_cycles == 43);
  CHECK(report.negotiation.count() == 35);
  CHECK(report.negotiation.quantile(30.0 / 35) < std::chrono::microseconds(1130));
  CHECK(report.negotiation.max() == std::chrono::milliseconds(2));
  CHECK(report.contacts == 5);
  CHECK(report.penetration_m_s == Approx(0.75));
  CHECK(report.firmware_violations == 1);
  CHECK(report.min_clearance_m == Approx(-0.01));
  CHECK(metrics.granting_since() == after(0));
  CHECK_THAT(report.failure_reason(),
             ContainsSubstring("5 contacts") && ContainsSubstring("1 firmware violations"));
}

TEST_CASE("a dead incarnation whose clock was ahead does not override its successor's status") {
  RunMetrics metrics(kTwo);
  metrics.on_coordinator(state(1, 0, kGranting));
  metrics.on_truth(truth(1, 1, {body(3, 1, 0)}));
  metrics.on_status(status(3, 1, kFencing, 5));
  metrics.on_status(status(3, 1, kDriving, 2));
  CHECK(metrics.progress()[0].agent_state == kDriving);
  CHECK(metrics.arrived() == 0);
  metrics.on_status(status(3, 2, kArrived, 2));
  CHECK(metrics.progress()[0].agent_state == kArrived);
  CHECK(metrics.arrived() == 1);
}

TEST_CASE("the status of a fencing agent counts only if no other incarnation of the agent reports") {
  RunMetrics metrics(kTwo);
  metrics.on_coordinator(state(1, 0, kGranting));
  metrics.on_truth(truth(1, 1, {body(3, 1, 0)}));
  const std::uint64_t fencing = GENERATE(4u, 6u);
  for (std::uint64_t number = 1; number <= 20; ++number) {
    metrics.on_status(status(3, number, kArrived, 5));
    CHECK(metrics.arrived() == 1);
    metrics.on_status(status(3, number, kFencing, fencing));
    CHECK(metrics.progress()[0].agent_state == kArrived);
    CHECK(metrics.arrived() == 1);
  }
  // Incarnation 5 has fallen silent.
  for (std::uint64_t number = 21; number <= 24; ++number)
    metrics.on_status(status(3, number, kFencing, fencing));
  CHECK(metrics.progress()[0].agent_state == kFencing);
  CHECK(metrics.arrived() == 0);
  metrics.on_status(status(3, 21, kArrived, 5));
  CHECK(metrics.arrived() == 1);
}

TEST_CASE("the status of the coordinator with the highest epoch counts") {
  RunMetrics metrics(kTwo);
  const auto of = [](std::uint32_t number, Epoch epoch, std::uint64_t message_number, double at_s,
                     msg::CoordinatorMode mode) {
    msg::CoordinatorState message = state(message_number, at_s, mode, 10 - number);
    message.coordinator(number);
    message.epoch(epoch);
    return message;
  };
  metrics.on_coordinator(of(1, 0, 1, 0.5, msg::CoordinatorMode::COORDINATOR_STANDBY));
  CHECK_FALSE(metrics.has_coordinator_state());
  auto registering = of(0, 100, 1, 1, kRegistering);
  registering.notices({missing_notice(3), missing_notice(7)});
  metrics.on_coordinator(registering);
  CHECK(metrics.unregistered_robots() == std::vector<RobotId>{3, 7});
  metrics.on_coordinator(of(0, 100, 2, 2, kGranting));
  registering = of(1, 200, 2, 3, kRegistering);
  registering.notices({missing_notice(7)});
  metrics.on_coordinator(registering);
  CHECK(metrics.unregistered_robots() == std::vector<RobotId>{7});
  metrics.on_coordinator(of(0, 100, 3, 4, kGranting));  // not yet superseded
  CHECK(metrics.unregistered_robots() == std::vector<RobotId>{7});
  metrics.on_coordinator(of(0, 0, 4, 5, msg::CoordinatorMode::COORDINATOR_STANDBY));
  CHECK(metrics.unregistered_robots() == std::vector<RobotId>{7});
  CHECK(metrics.granting_since() == after(2));
  CHECK(metrics.dropped_messages() == 0);
}

TEST_CASE("pairs of robots that the coordinator reports in conflict are recorded") {
  RunMetrics metrics(kTwo);
  auto message = state(1, 1, kGranting);
  message.conflicts(1);
  message.conflict_first(3);
  message.conflict_second(7);
  metrics.on_coordinator(message);
  CHECK(metrics.conflicts() == 1);
  message = state(2, 2, kGranting);
  metrics.on_coordinator(message);
  CHECK(metrics.conflicts() == 0);
  message = state(3, 3, kGranting);
  message.conflicts(1);
  message.conflict_first(3);
  message.conflict_second(99);  // not on the roster
  metrics.on_coordinator(message);
  CHECK(metrics.report().conflicts == std::set<std::pair<RobotId, RobotId>>{{3, 7}});
}

TEST_CASE("outdated and repeated ground truth is ignored") {
  RunMetrics metrics(kTwo);
  metrics.on_truth(truth(5, 5, {body(3, 1, 0)}));
  metrics.on_truth(truth(4, 4, {body(3, 0, 0)}));
  metrics.on_truth(truth(5, 5, {body(3, 0, 0)}));
  CHECK(metrics.progress()[0].distance_to_go_m == Approx(0));
  CHECK(metrics.seen_at() == after(5));
  CHECK(metrics.dropped_messages() == 2);
}

TEST_CASE("invalid messages are counted and dropped") {
  RunMetrics metrics(kTwo);
  metrics.on_status(status(4, 1, kDriving));                          // not on the roster
  metrics.on_status(status(3, 1, static_cast<msg::AgentState>(77)));  // no such state
  auto bad = truth(1, 1, {});
  bad.penetration_m_s(kNaN);
  metrics.on_truth(bad);
  bad = truth(1, 1, {});
  bad.valid_at_ns(std::numeric_limits<std::int64_t>::min());
  metrics.on_truth(bad);
  auto bad_state = state(1, 1, kGranting);
  bad_state.header().stamp_ns(std::numeric_limits<std::int64_t>::max());
  metrics.on_coordinator(bad_state);
  CHECK(metrics.dropped_messages() == 5);
  metrics.on_truth(truth(2, 2, {body(3, kNaN, 0), body(99, 0, 0), body(7, 1, 1)}));
  CHECK(metrics.dropped_messages() == 7);
  CHECK_FALSE(metrics.granting_since());
  CHECK(metrics.silent_agents() == std::vector<RobotId>{3, 7});
  CHECK(metrics.progress()[0].distance_to_go_m == Approx(1));
  CHECK(metrics.progress()[1].distance_to_go_m == Approx(1));
  CHECK(metrics.report().failure_reason() == "0 of 2 arrived");
}

TEST_CASE("the number of remembered incarnations is limited") {
  RunMetrics metrics(kTwo);
  for (std::uint64_t incarnation = 1; incarnation <= 3000; ++incarnation) {
    metrics.on_truth(truth(1, 1, {}, incarnation));
    metrics.on_coordinator(state(1, 1, kRegistering, incarnation));
  }
  CHECK(metrics.dropped_messages() >= 2000);
}

TEST_CASE("deaths are reported with process, reason and time since the first grant") {
  RunMetrics metrics(kTwo);
  metrics.on_coordinator(state(1, 1, kGranting));
  metrics.on_death("agent 3", "signal 9 (SIGKILL)", after(3.31), true);
  const Report report = metrics.report();
  REQUIRE(report.deaths.size() == 1);
  CHECK(report.deaths[0].at_s == Approx(2.31));
  CHECK_THAT(summary(report), ContainsSubstring("agent 3 died at 2.31 s: signal 9 (SIGKILL), restarted"));
}

TEST_CASE("progress has one row per robot with its state and motion") {
  RunMetrics metrics(kTwo);
  CHECK_FALSE(metrics.has_truth());
  CHECK(metrics.all_at_rest());
  metrics.on_truth(truth(1, 1, {body(3, 0.25, 0, 0.5), body(7, 0, 1)}));
  metrics.on_status(status(3, 1, kDriving));
  auto missing = state(1, 1, kRegistering);
  missing.notices({missing_notice(7)});
  metrics.on_coordinator(missing);
  CHECK_FALSE(metrics.all_at_rest());
  CHECK(metrics.silent_agents() == std::vector<RobotId>{7});
  CHECK(metrics.unregistered_robots() == std::vector<RobotId>{7});
  const auto rows = metrics.progress();
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].agent_state == kDriving);
  CHECK(rows[0].distance_to_go_m == Approx(0.75));
  CHECK(rows[0].speed_mps == Approx(0.5));
  CHECK_FALSE(rows[1].agent_state);
  CHECK(rows[1].team == Team::kYellow);
}

TEST_CASE("crashes are summed over the simulator's incarnations, and maximum speeds are kept") {
  RunMetrics metrics(kTwo);
  auto message = truth(1, 0.1, {});
  message.crashes(2);
  message.crashes_while_moving(1);
  message.max_crash_speed_mps(1.5);
  message.max_robot_crash_speed_mps(0.2);
  metrics.on_truth(message);
  auto next_incarnation = truth(1, 0.2, {}, 2);
  next_incarnation.crashes(1);
  next_incarnation.max_crash_speed_mps(0.7);
  next_incarnation.max_robot_crash_speed_mps(0.3);
  metrics.on_truth(next_incarnation);
  auto bad = truth(2, 0.3, {}, 2);
  bad.max_crash_speed_mps(kNaN);
  metrics.on_truth(bad);
  const Report report = metrics.report();
  CHECK(report.crashes == 3);
  CHECK(report.crashes_while_moving == 1);
  CHECK(report.max_crash_speed_mps == 1.5);
  CHECK(report.max_robot_crash_speed_mps == 0.3);
  CHECK(metrics.dropped_messages() == 1);
}

msg::Counters counters(std::uint32_t process, Incarnation incarnation, std::uint64_t number,
                       const DropCounters& drops) {
  msg::Counters message;
  message.process(process);
  message.header().sender(process);
  message.header().incarnation(incarnation);
  message.header().message_number(number);
  encode(drops, message);
  return message;
}

TEST_CASE("a process's latest counters are summed over robots and incarnations") {
  RunMetrics metrics(kTwo);
  DropCounters drops;
  drops.count(DropReason::kLateVersion, 3, 4);
  drops.count(DropReason::kLateVersion, 7, 5);
  metrics.on_counters(counters(30000, 1, 2, drops));
  drops.count(DropReason::kOtherRules, std::nullopt, 100);
  metrics.on_counters(counters(30000, 1, 1, drops));  // overtaken by a later message
  metrics.on_counters(counters(30000, 2, 1, drops));
  metrics.on_counters(counters(3, 1, 1, {}));
  const Report report = metrics.report();
  REQUIRE(report.counters.contains("simulator"));
  CHECK(report.counters.at("simulator").at(DropReason::kLateVersion) == 18);
  CHECK(report.counters.at("simulator").at(DropReason::kOtherRules) == 100);
  CHECK_FALSE(report.counters.contains("agent 3"));
  CHECK(report.counters.at("monitor").at(DropReason::kUnusedByMonitor) == 1);
  CHECK_THAT(summary(report), ContainsSubstring("refused: 100 other_rules by simulator\n"));
}

TEST_CASE("memory for counters is bounded when thousands of processes, incarnations and robots appear") {
  RunMetrics metrics(kTwo);
  DropCounters drops;
  drops.count(DropReason::kOtherRules);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    metrics.on_counters(counters(50'000 + i, 1, 1, drops));  // no process has this id
    metrics.on_counters(counters(20000, i + 1, 1, drops));
  }
  const Report report = metrics.report();
  CHECK(report.counters.size() == 2);
  CHECK(report.counters.at("vision").at(DropReason::kOtherRules) == 5000);
  CHECK(report.counters.at("monitor").at(DropReason::kUnusedByMonitor) == 5000);
}

TEST_CASE("the counters of a process that was restarted very often are summed without double counting") {
  RunMetrics metrics(kTwo);
  DropCounters drops;
  drops.count(DropReason::kOtherRules);
  for (Incarnation incarnation = 1; incarnation <= 100; ++incarnation) {
    metrics.on_counters(counters(20000, incarnation, 1, drops));
    metrics.on_counters(counters(20000, incarnation, 2, drops));
    if (incarnation > 50) metrics.on_counters(counters(20000, incarnation - 50, 3, drops));  // arrives late
  }
  CHECK(metrics.report().counters.at("vision").at(DropReason::kOtherRules) == 100);
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

TEST_CASE("the metrics record the robots' paths by ground truth, or by vision where there is none") {
  RunMetrics metrics(kTwo);
  metrics.on_truth(truth(1, 0, {body(3, 0, 0), body(7, 0, 1)}));
  metrics.on_truth(truth(2, 1, {body(3, 0.5, 0, 0.8), body(7, 0, 1)}));
  const FloorTrace trace = metrics.floor_trace();
  REQUIRE(trace.robots.size() == 2);
  REQUIRE(trace.robots[0].path.size() == 2);
  CHECK(trace.robots[0].path[1].position_m == Vec2(0.5, 0));
  CHECK(trace.robots[0].path[1].speed_mps == 0.8);

  RunMetrics seen(kTwo);
  msg::WorldState world;
  world.valid_at_ns(to_ns(after(2)));
  world.robots().resize(1);
  world.robots()[0].robot(7);
  world.robots()[0].x_m(0.25);
  seen.on_world_state(world);
  REQUIRE(seen.floor_trace().robots[1].path.size() == 1);
  CHECK(seen.floor_trace().robots[1].path[0].position_m == Vec2(0.25, 0));
}

TEST_CASE("sightings are the latest places of robots that were seen, by ground truth if there is any") {
  RunMetrics metrics(kTwo);
  CHECK(metrics.sightings().empty());
  msg::WorldState world;
  world.valid_at_ns(to_ns(after(1)));
  world.robots().emplace_back().robot(7);
  world.robots()[0].x_m(0.25);
  world.robots()[0].observed_x_m(0.2);
  world.robots()[0].observed_at_ns(to_ns(after(0.9)));
  metrics.on_world_state(world);
  // The robot is not seen any more, and vision predicts where it is.
  world.valid_at_ns(to_ns(after(1.5)));
  world.robots()[0].x_m(0.3);
  metrics.on_world_state(world);
  REQUIRE(metrics.sightings().size() == 1);
  CHECK(metrics.sightings()[0].robot == 7);
  CHECK(metrics.sightings()[0].position_m == Vec2(0.2, 0));
  CHECK(metrics.sightings()[0].at == after(0.9));
  metrics.on_truth(truth(1, 2, {body(3, 0.5, 0, 1.5), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  CHECK(metrics.sightings()[0].speed_mps == Approx(1.5));
  CHECK(metrics.sightings()[1].position_m == Vec2(0.75, 1));
  CHECK(metrics.sightings()[1].at == after(2));
  metrics.on_status(status(3, 1, msg::AgentState::AGENT_ABSENT));
  REQUIRE(metrics.sightings().size() == 1);
  CHECK(metrics.sightings()[0].robot == 7);
}

TEST_CASE("a robot that ground truth does not show has no sighting, because it is off the floor") {
  RunMetrics metrics(kTwo);
  metrics.on_truth(truth(1, 1, {body(3, 0.5, 0, 1.5), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  metrics.on_truth(truth(2, 1.1, {body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 1);
  CHECK(metrics.sightings()[0].robot == 7);
  metrics.on_truth(truth(3, 1.2, {body(3, 0.4, 0), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  CHECK(metrics.sightings()[0].position_m == Vec2(0.4, 0));
  // A robot whose state is invalid is on the floor.
  metrics.on_truth(truth(4, 1.3, {body(3, std::nan(""), 0), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  CHECK(metrics.sightings()[0].at == after(1.2));
}

}  // namespace sidestep::run_metrics_test
