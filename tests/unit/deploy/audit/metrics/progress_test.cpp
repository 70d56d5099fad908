// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/progress.hpp"

#include <algorithm>
#include <limits>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::progress_test {

const Scenario kFive = parse_scenario("circle: {count: 5, spacing_m: 0.5}\n", "five.yaml");

TEST_CASE("a progress line shows \"starting\" and later the time since the first grant") {
  RunMetrics metrics(kFive);
  CHECK_THAT(progress_line(metrics, time_from_ns(0)), StartsWith("starting  0 of 5 arrived"));
  msg::CoordinatorState state;
  state.header().incarnation(1);
  state.header().message_number(1);
  state.header().stamp_ns(2'000'000'000);
  state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  metrics.on_coordinator(state);
  const std::string line = progress_line(metrics, time_from_ns(5'500'000'000));
  CHECK_THAT(line, StartsWith("  3.5 s  0 of 5 arrived"));
  CHECK(line.find('\x1b') == std::string::npos);
  CHECK(line.find("clocks") == std::string::npos);
}

TEST_CASE("a progress line shows the largest measured clock offset") {
  RunMetrics metrics(kFive);
  const auto report = [&](std::uint32_t robot, std::uint64_t number, double offset_s, double uncertainty_s) {
    msg::AgentStatus status;
    status.robot(robot);
    status.header().incarnation(1);
    status.header().message_number(number);
    status.clock_offset_s(offset_s);
    status.clock_uncertainty_s(uncertainty_s);
    metrics.on_status(status);
  };
  report(0, 1, 0, -1);
  CHECK_FALSE(metrics.report().max_clock_offset_s);
  report(1, 1, 0.0001, 0.0003);
  report(2, 1, -0.0004, 0.0002);
  report(3, 1, 0.7, -1);
  report(4, 1, std::numeric_limits<double>::quiet_NaN(), 0.1);
  CHECK(metrics.report().max_clock_offset_s == 0.0004);
  CHECK(metrics.report().clock_uncertainty_s == 0.0002);
  CHECK_THAT(progress_line(metrics, time_from_ns(0)), ContainsSubstring("clocks 0.40 +- 0.20 ms"));
  report(2, 2, 0, 0.0001);
  CHECK(metrics.report().max_clock_offset_s == 0.0001);
}

TEST_CASE("a progress table has one line per robot and states how many robots do not fit") {
  RunMetrics metrics(kFive);
  msg::AgentStatus status;
  status.robot(2);
  status.header().incarnation(1);
  status.header().message_number(1);
  status.agent_state(msg::AgentState::AGENT_DRIVING);
  status.grants(123);
  metrics.on_status(status);
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  const std::string whole = progress_table(metrics, Time{}, 100);
  CHECK(lines(whole) == 2 + 5);
  CHECK_THAT(whole, ContainsSubstring("2  blue    driving") && ContainsSubstring("123"));
  CHECK_THAT(whole, ContainsSubstring("3  yellow  silent"));
  const std::string cut = progress_table(metrics, Time{}, 2);
  CHECK(lines(cut) == 2 + 2 + 1);
  CHECK_THAT(cut, EndsWith("... and 3 more\n"));
  CHECK(lines(progress_table(metrics, Time{}, -3)) == 2 + 1 + 1);
}

}  // namespace sidestep::progress_test
