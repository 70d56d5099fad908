// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/metrics/run_metrics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/config/scenario_loader.hpp"

namespace sidestep {
namespace {

const Scenario kTwo = parse_scenario(
    "robots:\n"
    "- {id: 3, start_m: [0, 0], goals_m: [[1, 0]]}\n"
    "- {id: 7, team: yellow, start_m: [0, 1], goals_m: [[0.5, 1], [2, 1]]}\n",
    "two.yaml");

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Time after(double seconds) { return kBegin + from_seconds(seconds); }

msg::Header head(std::uint64_t incarnation, std::uint64_t number, double at_s) {
  msg::Header header;
  header.incarnation(incarnation);
  header.message_number(number);
  header.stamp_ns(to_ns(after(at_s)));
  return header;
}

msg::TruthRobot body(RobotId robot, double x_m, double y_m, double vx_mps = 0) {
  msg::TruthRobot truth;
  truth.robot(robot);
  truth.x_m(x_m);
  truth.y_m(y_m);
  truth.vx_mps(vx_mps);
  truth.reference_error_m(0.001);
  return truth;
}

msg::GroundTruth truth(std::uint64_t number, double at_s, const std::vector<msg::TruthRobot>& robots,
                       std::uint64_t incarnation = 1) {
  msg::GroundTruth message;
  message.head(head(incarnation, number, at_s));
  message.at_ns(to_ns(after(at_s)));
  message.min_clearance_m(0.3);
  message.robots(robots);
  return message;
}

msg::AgentStatus status(RobotId robot, std::uint64_t number, msg::AgentState phase,
                        std::uint64_t incarnation = 1) {
  msg::AgentStatus message;
  message.robot(robot);
  message.head(head(incarnation, number, 0));
  message.agent_state(phase);
  return message;
}

msg::CoordinatorState state(std::uint64_t number, double at_s, msg::CoordinatorMode phase,
                            std::uint64_t incarnation = 1) {
  msg::CoordinatorState message;
  message.head(head(incarnation, number, at_s));
  message.coordinator_mode(phase);
  return message;
}

constexpr auto kRegistering = msg::CoordinatorMode::COORDINATOR_REGISTERING;
constexpr auto kGranting = msg::CoordinatorMode::COORDINATOR_GRANTING;
constexpr auto kDriving = msg::AgentState::AGENT_DRIVING;
constexpr auto kFencing = msg::AgentState::AGENT_FENCING;
constexpr auto kArrived = msg::AgentState::AGENT_ARRIVED;

}  // namespace

TEST_CASE("arrivals count from the first grant to the moment from which a robot stays at its last goal") {
  RunMetrics judge(kTwo);
  judge.on_coordinator(state(1, 0.5, kRegistering));
  CHECK_FALSE(judge.granting_since());
  judge.on_coordinator(state(2, 1.0, kGranting));
  judge.on_coordinator(state(3, 2.0, kGranting));
  CHECK(judge.granting_since() == after(1));

  judge.on_truth(truth(1, 2.0, {body(3, 0.99, 0, 0.5), body(7, 0.5, 1)}));      // 3 drives through
  judge.on_truth(truth(2, 3.0, {body(3, 1.01, 0), body(7, 1, 1, 1)}));          // 3 rests at its goal
  judge.on_truth(truth(3, 3.5, {body(3, 1.03, 0), body(7, 1.5, 1, 1)}));        // and is pushed off it
  judge.on_truth(truth(4, 4.0, {body(3, 1.019, 0, 0.019), body(7, 1.99, 1)}));  // and back
  judge.on_truth(truth(5, 5.0, {body(3, 1, 0), body(7, 2, 1)}));
  CHECK(judge.arrived() == 0);
  judge.on_status(status(3, 1, kArrived));
  CHECK(judge.arrived() == 1);
  CHECK_FALSE(judge.all_arrived());
  CHECK_FALSE(judge.report().makespan_s);
  CHECK_FALSE(judge.report().arrival_s.at(7));
  CHECK_THAT(judge.report().verdict(), Catch::Equals("1 of 2 arrived"));
  judge.on_status(status(7, 1, kArrived));
  CHECK(judge.all_arrived());

  const Report report = judge.report();
  CHECK(report.verdict().empty());
  CHECK(report.arrival_s.at(3) == Approx(3));
  CHECK(report.arrival_s.at(7) == Approx(3));
  CHECK(report.makespan_s == Approx(3));
  CHECK(report.mean_arrival_s == Approx(3));
  CHECK(report.robot_time_s == Approx(4));
  CHECK(report.max_reference_error_m == Approx(0.001));
  CHECK(report.min_clearance_m == Approx(0.3));
  const double expected =
      (3 / straight_time_s(kTwo.robots[0], kTwo.limits) + 3 / straight_time_s(kTwo.robots[1], kTwo.limits)) /
      2;
  CHECK(report.arrival_over_straight == Approx(expected));
}

TEST_CASE("a robot that leaves its goal has not arrived") {
  RunMetrics judge(kTwo);
  judge.on_coordinator(state(1, 0, kGranting));
  judge.on_status(status(3, 1, kArrived));
  judge.on_truth(truth(1, 1, {body(3, 1, 0)}));
  CHECK(judge.arrived() == 1);
  judge.on_truth(truth(2, 2, {body(3, 1.1, 0)}));
  CHECK(judge.arrived() == 0);
  judge.on_truth(truth(3, 3, {body(3, 1, 0)}));
  judge.on_status(status(3, 2, kDriving));
  CHECK(judge.arrived() == 0);
}

TEST_CASE("the straight-line time agrees with slow integration") {
  for (const double goal_m : {0.01, 0.5, 1.06, 1.07, 3.0, 12.0}) {
    CAPTURE(goal_m);
    MotionLimits limits;
    RobotSpec robot;
    robot.goals = {Goal{{goal_m, 0}, std::nullopt}};
    // Accelerate in small steps while the braking distance is still left.
    double x = 0, v = 0, t = 0;
    const double dt = 1e-5;
    while (goal_m - x > 1e-6) {
      const bool may_push = goal_m - x > v * v / (2 * limits.deceleration_mps2);
      v = may_push ? std::min(limits.speed_mps, v + limits.acceleration_mps2 * dt)
                   : std::max(1e-3, v - limits.deceleration_mps2 * dt);
      x += v * dt;
      t += dt;
    }
    CHECK(straight_time_s(robot, limits) == Approx(t).margin(4e-3));
  }
}

TEST_CASE("counters are summed over the lives of restarted agents, simulators and coordinators") {
  RunMetrics judge(kTwo);
  const auto agent = [](std::uint64_t incarnation, std::uint64_t number, std::uint64_t base) {
    msg::AgentStatus message = status(3, number, kDriving, incarnation);
    message.proposals(base);
    message.grants(base + 1);
    message.denials(base + 2);
    message.cycles(base + 3);
    message.missed_cycles(base + 4);
    message.invalid(base + 5);
    DurationHistogram histogram;
    for (std::uint64_t i = 0; i < base; ++i) histogram.add(std::chrono::milliseconds(incarnation));
    histogram.to_message(message.negotiation());
    return message;
  };
  judge.on_status(agent(1, 1, 10));
  judge.on_status(agent(1, 2, 20));
  judge.on_status(agent(2, 1, 5));
  judge.on_status(agent(1, 3, 30));  // late word from the first life
  judge.on_status(agent(1, 2, 20));  // and a repetition of an older one
  CHECK(judge.dropped() == 1);

  auto seen = truth(9, 1, {}, 1);
  seen.contacts(2);
  seen.penetration_m_s(0.25);
  seen.firmware_violations(1);
  judge.on_truth(seen);
  auto later = truth(1, 2, {}, 2);
  later.contacts(3);
  later.penetration_m_s(0.5);
  later.min_clearance_m(-0.01);
  judge.on_truth(later);

  auto coordinator = state(1, 0, kGranting, 1);
  coordinator.invalid(4);
  judge.on_coordinator(coordinator);
  judge.on_coordinator(state(1, 3, kRegistering, 2));

  const Report report = judge.report();
  CHECK(report.proposals == 35);
  CHECK(report.grants == 37);
  CHECK(report.denials == 39);
  CHECK(report.cycles == 41);
  CHECK(report.missed_cycles == 43);
  CHECK(report.invalid_messages == 45 + 4);
  CHECK(report.negotiation.count() == 35);
  CHECK(report.negotiation.quantile(30.0 / 35) < std::chrono::microseconds(1130));
  CHECK(report.negotiation.largest() == std::chrono::milliseconds(2));
  CHECK(report.contacts == 5);
  CHECK(report.penetration_m_s == Approx(0.75));
  CHECK(report.firmware_violations == 1);
  CHECK(report.min_clearance_m == Approx(-0.01));
  CHECK(judge.granting_since() == after(0));
  CHECK_THAT(report.verdict(), Catch::Contains("5 contacts") && Catch::Contains("1 firmware violations"));
}

TEST_CASE("an agent that began on a clock that was ahead, and died, does not speak for the one after it") {
  RunMetrics judge(kTwo);
  judge.on_coordinator(state(1, 0, kGranting));
  judge.on_truth(truth(1, 1, {body(3, 1, 0)}));
  judge.on_status(status(3, 1, kFencing, 5));
  judge.on_status(status(3, 1, kDriving, 2));
  CHECK(judge.progress()[0].phase == kDriving);
  CHECK(judge.arrived() == 0);
  judge.on_status(status(3, 2, kArrived, 2));
  CHECK(judge.progress()[0].phase == kArrived);
  CHECK(judge.arrived() == 1);
}

TEST_CASE("an agent that does not get through to its robot does not speak for it while another one does") {
  RunMetrics judge(kTwo);
  judge.on_coordinator(state(1, 0, kGranting));
  judge.on_truth(truth(1, 1, {body(3, 1, 0)}));
  const std::uint64_t other = GENERATE(4u, 6u);
  for (std::uint64_t number = 1; number <= 20; ++number) {
    judge.on_status(status(3, number, kArrived, 5));
    CHECK(judge.arrived() == 1);
    judge.on_status(status(3, number, kFencing, other));
    CHECK(judge.progress()[0].phase == kArrived);
    CHECK(judge.arrived() == 1);
  }
  // The other one has died.
  for (std::uint64_t number = 21; number <= 24; ++number) judge.on_status(status(3, number, kFencing, other));
  CHECK(judge.progress()[0].phase == kFencing);
  CHECK(judge.arrived() == 0);
  judge.on_status(status(3, 21, kArrived, 5));
  CHECK(judge.arrived() == 1);
}

TEST_CASE("of several coordinators the one with the highest epoch speaks, and the counts of all are summed") {
  RunMetrics judge(kTwo);
  const auto of = [](std::uint32_t number, Epoch epoch, std::uint64_t message_number, double at_s,
                     msg::CoordinatorMode phase) {
    msg::CoordinatorState message = state(message_number, at_s, phase, 10 - number);
    message.coordinator(number);
    message.epoch(epoch);
    message.invalid(10 + number);
    return message;
  };
  judge.on_coordinator(of(1, 0, 1, 0.5, msg::CoordinatorMode::COORDINATOR_STANDBY));
  CHECK_FALSE(judge.coordinator_seen());
  auto registering = of(0, 100, 1, 1, kRegistering);
  registering.missing({3, 7});
  judge.on_coordinator(registering);
  CHECK(judge.unregistered() == std::vector<RobotId>{3, 7});
  judge.on_coordinator(of(0, 100, 2, 2, kGranting));
  registering = of(1, 200, 2, 3, kRegistering);
  registering.missing({7});
  judge.on_coordinator(registering);
  CHECK(judge.unregistered() == std::vector<RobotId>{7});
  judge.on_coordinator(of(0, 100, 3, 4, kGranting));  // has not heard of it yet
  CHECK(judge.unregistered() == std::vector<RobotId>{7});
  judge.on_coordinator(of(0, 0, 4, 5, msg::CoordinatorMode::COORDINATOR_STANDBY));
  CHECK(judge.unregistered() == std::vector<RobotId>{7});
  CHECK(judge.granting_since() == after(2));
  CHECK(judge.report().invalid_messages == 21);
  CHECK(judge.dropped() == 0);
}

TEST_CASE("pairs of robots that the coordinator names as in conflict are remembered") {
  RunMetrics judge(kTwo);
  auto message = state(1, 1, kGranting);
  message.conflicts(1);
  message.conflict_first(3);
  message.conflict_second(7);
  judge.on_coordinator(message);
  CHECK(judge.conflicts() == 1);
  message = state(2, 2, kGranting);
  judge.on_coordinator(message);
  CHECK(judge.conflicts() == 0);
  message = state(3, 3, kGranting);
  message.conflicts(1);
  message.conflict_first(3);
  message.conflict_second(99);  // nobody
  judge.on_coordinator(message);
  CHECK(judge.report().conflicts == std::set<std::pair<RobotId, RobotId>>{{3, 7}});
}

TEST_CASE("old and repeated ground truth does not move robots back") {
  RunMetrics judge(kTwo);
  judge.on_truth(truth(5, 5, {body(3, 1, 0)}));
  judge.on_truth(truth(4, 4, {body(3, 0, 0)}));
  judge.on_truth(truth(5, 5, {body(3, 0, 0)}));
  CHECK(judge.progress()[0].distance_to_go_m == Approx(0));
  CHECK(judge.truth_at() == after(5));
  CHECK(judge.dropped() == 2);
}

TEST_CASE("messages that make no sense are counted and dropped") {
  RunMetrics judge(kTwo);
  judge.on_status(status(4, 1, kDriving));                          // nobody's
  judge.on_status(status(3, 1, static_cast<msg::AgentState>(77)));  // no phase
  auto bad = truth(1, 1, {});
  bad.penetration_m_s(kNaN);
  judge.on_truth(bad);
  bad = truth(1, 1, {});
  bad.at_ns(std::numeric_limits<std::int64_t>::min());
  judge.on_truth(bad);
  auto state_of_hell = state(1, 1, kGranting);
  state_of_hell.head().stamp_ns(std::numeric_limits<std::int64_t>::max());
  judge.on_coordinator(state_of_hell);
  CHECK(judge.dropped() == 5);
  judge.on_truth(truth(2, 2, {body(3, kNaN, 0), body(99, 0, 0), body(7, 1, 1)}));
  CHECK(judge.dropped() == 7);
  CHECK_FALSE(judge.granting_since());
  CHECK(judge.silent_agents() == std::vector<RobotId>{3, 7});
  CHECK(judge.progress()[0].distance_to_go_m == Approx(1));
  CHECK(judge.progress()[1].distance_to_go_m == Approx(1));
  CHECK(judge.report().verdict() == "0 of 2 arrived");
}

TEST_CASE("a stream of invented lives is cut off") {
  RunMetrics judge(kTwo);
  for (std::uint64_t life = 1; life <= 3000; ++life) {
    judge.on_truth(truth(1, 1, {}, life));
    judge.on_coordinator(state(1, 1, kRegistering, life));
  }
  CHECK(judge.dropped() >= 2000);
}

TEST_CASE("deaths are told with name, reason and time after the first grant") {
  RunMetrics judge(kTwo);
  judge.on_coordinator(state(1, 1, kGranting));
  judge.on_death("agent 3", "signal 9 (SIGKILL)", after(3.31), true);
  const Report report = judge.report();
  REQUIRE(report.deaths.size() == 1);
  CHECK(report.deaths[0].at_s == Approx(2.31));
  CHECK_THAT(summary(report), Catch::Contains("agent 3 died at 2.31 s: signal 9 (SIGKILL), restarted"));
}

TEST_CASE("progress has a row for each robot and says who is silent or moving") {
  RunMetrics judge(kTwo);
  CHECK_FALSE(judge.truth_seen());
  CHECK(judge.all_at_rest());
  judge.on_truth(truth(1, 1, {body(3, 0.25, 0, 0.5), body(7, 0, 1)}));
  judge.on_status(status(3, 1, kDriving));
  auto missing = state(1, 1, kRegistering);
  missing.missing({7});
  judge.on_coordinator(missing);
  CHECK_FALSE(judge.all_at_rest());
  CHECK(judge.silent_agents() == std::vector<RobotId>{7});
  CHECK(judge.unregistered() == std::vector<RobotId>{7});
  const auto rows = judge.progress();
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].phase == kDriving);
  CHECK(rows[0].distance_to_go_m == Approx(0.75));
  CHECK(rows[0].speed_mps == Approx(0.5));
  CHECK_FALSE(rows[1].phase);
  CHECK(rows[1].team == Team::kYellow);
}

TEST_CASE("crashes are summed over the simulator's lives, and of speeds the largest counts") {
  RunMetrics judge(kTwo);
  auto message = truth(1, 0.1, {});
  message.crashes(2);
  message.moving_crashes(1);
  message.crash_speed_mps(1.5);
  message.robot_crash_speed_mps(0.2);
  judge.on_truth(message);
  auto next_life = truth(1, 0.2, {}, 2);
  next_life.crashes(1);
  next_life.crash_speed_mps(0.7);
  next_life.robot_crash_speed_mps(0.3);
  judge.on_truth(next_life);
  auto bad = truth(2, 0.3, {}, 2);
  bad.crash_speed_mps(kNaN);
  judge.on_truth(bad);
  const Report report = judge.report();
  CHECK(report.crashes == 3);
  CHECK(report.moving_crashes == 1);
  CHECK(report.crash_speed_mps == 1.5);
  CHECK(report.robot_crash_speed_mps == 0.3);
  CHECK(judge.dropped() == 1);
}

}  // namespace sidestep
