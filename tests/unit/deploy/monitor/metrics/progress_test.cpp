// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/metrics/progress.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "common/config/scenario_loader.hpp"

namespace sidestep {
namespace {

const Scenario kFive = parse_scenario("circle: {count: 5, spacing_m: 0.5}\n", "five.yaml");

}  // namespace

TEST_CASE("a progress line says that the run is starting, then the time since the first grant") {
  RunMetrics judge(kFive);
  CHECK_THAT(progress_line(judge, time_from_ns(0)), Catch::StartsWith("starting  0 of 5 arrived"));
  msg::CoordinatorState state;
  state.head().incarnation(1);
  state.head().message_number(1);
  state.head().stamp_ns(2'000'000'000);
  state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  judge.on_coordinator(state);
  const std::string line = progress_line(judge, time_from_ns(5'500'000'000));
  CHECK_THAT(line, Catch::StartsWith("  3.5 s  0 of 5 arrived"));
  CHECK(line.find('\x1b') == std::string::npos);
  CHECK(line.find("clocks") == std::string::npos);
}

TEST_CASE("a progress line shows the largest offset between clocks that was measured") {
  RunMetrics judge(kFive);
  const auto say = [&](std::uint32_t robot, std::uint64_t number, double offset_s, double uncertainty_s) {
    msg::AgentStatus status;
    status.robot(robot);
    status.head().incarnation(1);
    status.head().message_number(number);
    status.clock_offset_s(offset_s);
    status.clock_uncertainty_s(uncertainty_s);
    judge.on_status(status);
  };
  say(0, 1, 0, -1);
  CHECK_FALSE(judge.report().clock_offset_max_s);
  say(1, 1, 0.0001, 0.0003);
  say(2, 1, -0.0004, 0.0002);
  say(3, 1, 0.7, -1);
  say(4, 1, std::numeric_limits<double>::quiet_NaN(), 0.1);
  CHECK(judge.report().clock_offset_max_s == 0.0004);
  CHECK(judge.report().clock_uncertainty_s == 0.0002);
  CHECK_THAT(progress_line(judge, time_from_ns(0)), Catch::Contains("clocks 0.40 +- 0.20 ms"));
  say(2, 2, 0, 0.0001);
  CHECK(judge.report().clock_offset_max_s == 0.0001);
}

TEST_CASE("a progress table has a line for each robot, and says how many do not fit") {
  RunMetrics judge(kFive);
  msg::AgentStatus status;
  status.robot(2);
  status.head().incarnation(1);
  status.head().message_number(1);
  status.agent_state(msg::AgentState::AGENT_DRIVING);
  status.grants(123);
  judge.on_status(status);
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  const std::string whole = progress_table(judge, Time{}, 100);
  CHECK(lines(whole) == 2 + 5);
  CHECK_THAT(whole, Catch::Contains("2  blue    driving") && Catch::Contains("123"));
  CHECK_THAT(whole, Catch::Contains("3  yellow  silent"));
  const std::string cut = progress_table(judge, Time{}, 2);
  CHECK(lines(cut) == 2 + 2 + 1);
  CHECK_THAT(cut, Catch::EndsWith("... and 3 more\n"));
  CHECK(lines(progress_table(judge, Time{}, -3)) == 2 + 1 + 1);
}

}  // namespace sidestep
