// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/drop_codec.hpp"
#include "common/messaging/histogram_codec.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/metrics/run_metrics_messages.hpp"

namespace sidestep::run_metrics_test {

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

}  // namespace sidestep::run_metrics_test
