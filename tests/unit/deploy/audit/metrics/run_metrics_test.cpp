// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/run_metrics.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/metrics/run_metrics_messages.hpp"

namespace sidestep::run_metrics_test {

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

}  // namespace sidestep::run_metrics_test
