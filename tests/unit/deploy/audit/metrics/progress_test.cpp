// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/progress.hpp"

#include <algorithm>
#include <limits>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"
#include "tests/pseudo_terminal.hpp"
#include "tests/screen.hpp"

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

std::ptrdiff_t lines_of(const std::string& text) { return std::ranges::count(text, '\n'); }

/// Metrics of five robots of which one drives and the others are silent.
RunMetrics driving_metrics() {
  RunMetrics metrics(kFive);
  msg::AgentStatus status;
  status.robot(2);
  status.header().incarnation(1);
  status.header().message_number(1);
  status.agent_state(msg::AgentState::AGENT_DRIVING);
  status.grants(123);
  metrics.on_status(status);
  return metrics;
}

TEST_CASE("a progress table has one line per robot and states how many robots do not fit") {
  const RunMetrics metrics = driving_metrics();
  const std::string whole = progress_table(metrics, Time{}, {200, 100});
  CHECK(lines_of(whole) == 2 + 5);
  CHECK_THAT(whole, ContainsSubstring("2  blue    driving") && ContainsSubstring("123"));
  CHECK_THAT(whole, ContainsSubstring("3  yellow  silent"));
  CHECK(progress_table(metrics, Time{}, {200, 8}) == whole);
  const std::string cut = progress_table(metrics, Time{}, {200, 6});
  CHECK(lines_of(cut) == 2 + 2 + 1);
  CHECK_THAT(cut, EndsWith("... and 3 more\n"));
  for (const int rows : {0, 1, 4}) CHECK(lines_of(progress_table(metrics, Time{}, {200, rows})) == 2 + 1 + 1);
}

TEST_CASE("a progress table fits into the width of the screen, and the most important columns stay") {
  const RunMetrics metrics = driving_metrics();
  const std::string at_60 = progress_table(metrics, Time{}, {60, 24}),
                    at_80 = progress_table(metrics, Time{}, {80, 24}),
                    at_120 = progress_table(metrics, Time{}, {120, 24});
  CHECK_THAT(at_60, StartsWith("starting  0 of 5 arrived  0 contacts  clearance ?\n"
                               "123 grants  0 denials  0.00 % missed\n"
                               "negotiation 0.00 / 0.00 ms  clocks 0.00 +- 0.00 ms\n"
                               "robot  team    state           to go      speed   grants\n"
                               "    0  blue    silent  "));
  CHECK_THAT(at_60, ContainsSubstring("\n    2  blue    driving  ") &&
                        ContainsSubstring("   0.00 m/s      123\n    3  yellow  silent  "));
  CHECK_THAT(at_80,
             StartsWith("starting  0 of 5 arrived  0 contacts  clearance ?  123 grants  0 denials\n"
                        "0.00 % missed  negotiation 0.00 / 0.00 ms  clocks 0.00 +- 0.00 ms\n"
                        "robot  team    state           to go      speed   grants  denials  p50 / p99 ms\n"));
  CHECK_THAT(at_80, ContainsSubstring("   0.00 m/s      123        0   0.00 / 0.00\n"));
  CHECK_THAT(at_120, ContainsSubstring(" denials  negotiation p50 / p99 ms\n"));
  for (int columns = 30; columns < 130; ++columns) {
    const std::string table = progress_table(metrics, Time{}, {columns, 24});
    CAPTURE(columns, table);
    for (std::size_t at = 0; at < table.size(); at = table.find('\n', at) + 1)
      CHECK(table.find('\n', at) - at < static_cast<std::size_t>(columns));
  }
}

TEST_CASE("a progress table has colours only if they are wanted") {
  const RunMetrics metrics = driving_metrics();
  const std::string plain = progress_table(metrics, Time{}, {80, 24}),
                    colourful = progress_table(metrics, Time{}, {80, 24}, true);
  CHECK(plain.find('\x1b') == std::string::npos);
  CHECK_THAT(colourful, ContainsSubstring("\x1b[31msilent     \x1b[0m") && ContainsSubstring("  driving  ") &&
                            ContainsSubstring("\x1b[1mrobot  team"));
}

TEST_CASE("a summary's verdict has the colour of the verdict") {
  const std::string summary = "5 of 5 robots arrived\npassed\n";
  CHECK(with_coloured_verdict(summary, AuditVerdict::kPassed) ==
        "5 of 5 robots arrived\n\x1b[32mpassed\x1b[0m\n");
  CHECK(with_coloured_verdict("failed: why\n", AuditVerdict::kFailed) == "\x1b[31mfailed: why\x1b[0m\n");
  CHECK_THAT(with_coloured_verdict(summary, AuditVerdict::kNotJudged), ContainsSubstring("\x1b[33mpassed"));
}

/// What a terminal shows of a run of five robots, the second of which is reported to have died meanwhile.
Screen shown_run(int columns, int rows) {
  const PseudoTerminal terminal(columns, rows);
  ProgressDisplay display(terminal.stream());
  RunMetrics metrics = driving_metrics();
  Screen screen(columns, rows);
  for (int tenth = 0; tenth < 30; ++tenth) {
    if (tenth == 15) display.print("agent 1 died", LogLevel::kWarning);
    display.update(metrics, time_from_ns(std::int64_t{100'000'000} * tenth));
    screen.feed(terminal.read_all());
  }
  return screen;
}

TEST_CASE("a terminal of any width shows one table below the lines that stay") {
  const bool wants_colours = GENERATE(true, false);
  const EnvironmentVariable term("TERM", "xterm"), no_color("NO_COLOR", wants_colours ? nullptr : "1");
  const int columns = GENERATE(60, 80, 120);
  const Screen screen = shown_run(columns, 24);
  const std::string table = progress_table(driving_metrics(), Time{}, {columns, 24});
  CAPTURE(columns);
  CHECK(screen.text() == "agent 1 died\n" + table);
  CHECK(screen.wraps() == 0);
  CHECK(screen.unknown().empty());
  CHECK((screen.colours() > 0) == wants_colours);
}

TEST_CASE("what is no terminal, or a dumb one, gets a line per second without control characters") {
  const EnvironmentVariable term("TERM", "dumb"), no_color("NO_COLOR", nullptr);
  const Screen screen = shown_run(80, 24);
  CHECK(screen.count("starting  0 of 5 arrived") == 3);
  CHECK(screen.count("robot  team") == 0);
  CHECK(screen.count("agent 1 died") == 1);
  CHECK(screen.colours() == 0);
  CHECK(screen.unknown().empty());
}

}  // namespace sidestep::progress_test
